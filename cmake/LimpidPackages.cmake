# CPack: Debian packages from the components of LimpidInstall.cmake. scripts/package.sh builds them.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME limpid)
set(CPACK_PACKAGE_VENDOR "The Limpid authors")
set(CPACK_PACKAGE_CONTACT "The Limpid authors <limpid@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # set for each package below
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(LIMPID_DEB_VERSION ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_COMPONENTS_ALL library development)
if(LIMPID_APPS)
  list(APPEND CPACK_COMPONENTS_ALL program)
endif()
if(TARGET limpid_mpi)
  list(APPEND CPACK_COMPONENTS_ALL mpi)
endif()
if(LIMPID_APPS OR TARGET limpid_neural)
  list(APPEND CPACK_COMPONENTS_ALL weights)
endif()
if(TARGET limpid_neural)
  list(APPEND CPACK_COMPONENTS_ALL neural neural_development)
endif()
if(TARGET limpid_shot)
  list(APPEND CPACK_COMPONENTS_ALL shot shot_development)
endif()
if(TARGET limpid_python_denoise)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# The Python module needs liblimpid, which is in another of these packages. Its dependency is added by hand below;
# dpkg-shlibdeps only has to find the library.
get_target_property(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS limpid_denoise BINARY_DIR)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME liblimpid0)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "real-time denoisers for any Vulkan device
Filters noisy pictures of path tracers, frame by frame: SVGF and others. They
record into the command buffers of a program with a Vulkan device of its own,
or take pictures in host memory.")
# Run ldconfig when the library is installed or removed.
file(WRITE ${PROJECT_BINARY_DIR}/install/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/install/triggers)
# Vulkan's loader is opened at run time, so dpkg-shlibdeps does not find this dependency.
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS libvulkan1)

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME liblimpid-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "liblimpid0 (= ${LIMPID_DEB_VERSION}), libvulkan-dev")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "real-time denoisers for any Vulkan device, to build programs with
Headers for C and C++, a CMake package and a pkg-config file.")

set(CPACK_DEBIAN_NEURAL_PACKAGE_NAME liblimpid-neural0)
set(CPACK_DEBIAN_NEURAL_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_NEURAL_PACKAGE_DEPENDS "libvulkan1, limpid-weights (= ${LIMPID_DEB_VERSION})")
set(CPACK_DEBIAN_NEURAL_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/install/triggers)
set(CPACK_DEBIAN_NEURAL_DESCRIPTION "denoising network for any Vulkan device
Cleans pictures of path tracers with a trained network that predicts kernels:
single frames of about 32 samples per pixel, in host memory.")

set(CPACK_DEBIAN_NEURAL_DEVELOPMENT_PACKAGE_NAME liblimpid-neural-dev)
set(CPACK_DEBIAN_NEURAL_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_NEURAL_DEVELOPMENT_PACKAGE_DEPENDS
  "liblimpid-neural0 (= ${LIMPID_DEB_VERSION}), liblimpid-dev (= ${LIMPID_DEB_VERSION})")
set(CPACK_DEBIAN_NEURAL_DEVELOPMENT_DESCRIPTION "denoising network for any Vulkan device, to build programs with
Headers for C and C++, the component 'neural' of Limpid's CMake package and a
pkg-config file.")

set(CPACK_DEBIAN_SHOT_PACKAGE_NAME liblimpid-shot0)
set(CPACK_DEBIAN_SHOT_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_SHOT_PACKAGE_DEPENDS libvulkan1)
set(CPACK_DEBIAN_SHOT_PACKAGE_RECOMMENDS "limpid-weights (= ${LIMPID_DEB_VERSION})")
set(CPACK_DEBIAN_SHOT_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/install/triggers)
set(CPACK_DEBIAN_SHOT_DESCRIPTION "denoising of other renderers' EXR files
Recognises the layers of Blender, Mitsuba, pbrt, Arnold, RenderMan and Karma,
and cleans the frames of a shot on any Vulkan device.")

set(CPACK_DEBIAN_SHOT_DEVELOPMENT_PACKAGE_NAME liblimpid-shot-dev)
set(CPACK_DEBIAN_SHOT_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_SHOT_DEVELOPMENT_PACKAGE_DEPENDS
  "liblimpid-shot0 (= ${LIMPID_DEB_VERSION}), liblimpid-dev (= ${LIMPID_DEB_VERSION})")
set(CPACK_DEBIAN_SHOT_DEVELOPMENT_DESCRIPTION "denoising of other renderers' EXR files, to build programs with
Headers for C and C++, the component 'shot' of Limpid's CMake package and a
pkg-config file.")

set(CPACK_DEBIAN_WEIGHTS_PACKAGE_NAME limpid-weights)
set(CPACK_DEBIAN_WEIGHTS_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_WEIGHTS_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_WEIGHTS_DESCRIPTION "weights of Limpid's denoising network
Trained weights, which the program limpid and its library liblimpid-neural
read.")

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME limpid)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "libvulkan1, limpid-weights (= ${LIMPID_DEB_VERSION})")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "mesa-vulkan-drivers, fonts-inter | fonts-roboto-unhinted | fonts-dejavu-core")
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "real-time path tracer and denoiser for any Vulkan device
Renders glTF and OBJ scenes, cleans noisy EXR sequences, and compares
pictures, on GPUs and on CPUs.")

set(CPACK_DEBIAN_MPI_PACKAGE_NAME limpid-mpi)
set(CPACK_DEBIAN_MPI_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_MPI_PACKAGE_DEPENDS "limpid (= ${LIMPID_DEB_VERSION})")
set(CPACK_DEBIAN_MPI_PACKAGE_RECOMMENDS openmpi-bin)
set(CPACK_DEBIAN_MPI_DESCRIPTION "real-time path tracer and denoiser, for clusters
Lets several processes share a render, the frames of a shot or a dataset: a
module of the program limpid for MPI.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-limpid)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
if(TARGET limpid_python_denoise)
  # An extension module works with only one minor version of Python.
  math(EXPR LIMPID_NEXT_PYTHON "${LIMPID_PYTHON_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "liblimpid0 (= ${LIMPID_DEB_VERSION}), python3-numpy, \
python3 (>= 3.${LIMPID_PYTHON_MINOR}), python3 (<< 3.${LIMPID_NEXT_PYTHON})")
  if(TARGET limpid_neural)
    string(APPEND CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS ", liblimpid-neural0 (= ${LIMPID_DEB_VERSION})")
    get_target_property(LIMPID_NEURAL_DIR limpid_neural BINARY_DIR)  # for dpkg-shlibdeps
    list(APPEND CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${LIMPID_NEURAL_DIR})
  endif()
  if(TARGET limpid_shot)
    string(APPEND CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS ", liblimpid-shot0 (= ${LIMPID_DEB_VERSION})")
    get_target_property(LIMPID_SHOT_DIR limpid_shot BINARY_DIR)
    list(APPEND CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${LIMPID_SHOT_DIR})
  endif()
endif()
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "real-time denoisers for any Vulkan device, for Python
NumPy arrays in, NumPy arrays out: denoises stills and sequences, renders
scenes, and compares pictures.")
include(CPack)

# limpid_gzip(FILE RESULT): compresses a file, without its name and time. It runs while configuring, not in a build
# target, because one may build and install only the library.
function(limpid_gzip FILE RESULT)
  execute_process(COMMAND ${LIMPID_GZIP} -9nc ${FILE} OUTPUT_FILE ${RESULT} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# Install licence and changelog where Debian expects them: usr/share/doc/PACKAGE.
string(TIMESTAMP LIMPID_DEB_DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)
configure_file(${PROJECT_SOURCE_DIR}/cmake/changelog.Debian.in ${PROJECT_BINARY_DIR}/install/changelog.Debian @ONLY)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/CHANGELOG.md)
limpid_gzip(${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_BINARY_DIR}/install/changelog.gz)
limpid_gzip(${PROJECT_BINARY_DIR}/install/changelog.Debian ${PROJECT_BINARY_DIR}/install/changelog.Debian.gz)
foreach(COMPONENT ${CPACK_COMPONENTS_ALL})
  string(TOUPPER ${COMPONENT} UPPER)
  set(DOCUMENTS ${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_${UPPER}_PACKAGE_NAME})
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${DOCUMENTS} RENAME copyright COMPONENT ${COMPONENT})
  install(FILES ${PROJECT_BINARY_DIR}/install/changelog.gz ${PROJECT_BINARY_DIR}/install/changelog.Debian.gz
    DESTINATION ${DOCUMENTS} COMPONENT ${COMPONENT})
endforeach()
