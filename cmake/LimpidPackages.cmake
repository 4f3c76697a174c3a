# CPack: Debian packages from the components of LimpidInstall.cmake. scripts/package.sh builds them.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME limpid)
set(CPACK_PACKAGE_VENDOR "The Limpid authors")
set(CPACK_PACKAGE_CONTACT "The Limpid authors <limpid@localhost>")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_COMPONENTS_ALL library development)
if(LIMPID_APPS)
  list(APPEND CPACK_COMPONENTS_ALL program)
endif()
if(LIMPID_APPS OR TARGET limpid_neural)
  list(APPEND CPACK_COMPONENTS_ALL weights)
endif()
if(TARGET limpid_neural)
  list(APPEND CPACK_COMPONENTS_ALL neural neural_development)
endif()
if(TARGET limpid_python_denoise)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME liblimpid0)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "real-time denoisers for any Vulkan device
 Filters noisy pictures of path tracers, frame by frame: SVGF and others. They
 record into the command buffers of a program with a Vulkan device of its own,
 or take pictures in host memory.")
# The loader is opened when a device is made, so that dpkg-shlibdeps does not see it.
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS libvulkan1)

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME liblimpid-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "liblimpid0 (= ${PROJECT_VERSION}), libvulkan-dev")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "real-time denoisers for any Vulkan device, to build programs with
 Headers for C and C++, a CMake package and a pkg-config file.")

set(CPACK_DEBIAN_NEURAL_PACKAGE_NAME liblimpid-neural0)
set(CPACK_DEBIAN_NEURAL_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_NEURAL_PACKAGE_DEPENDS "libvulkan1, limpid-weights (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_NEURAL_DESCRIPTION "denoising network for any Vulkan device
 Cleans pictures of path tracers with a trained network that predicts kernels:
 single frames of about 32 samples per pixel, in host memory.")

set(CPACK_DEBIAN_NEURAL_DEVELOPMENT_PACKAGE_NAME liblimpid-neural-dev)
set(CPACK_DEBIAN_NEURAL_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_NEURAL_DEVELOPMENT_PACKAGE_DEPENDS
  "liblimpid-neural0 (= ${PROJECT_VERSION}), liblimpid-dev (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_NEURAL_DEVELOPMENT_DESCRIPTION "denoising network for any Vulkan device, to build programs with
 Headers for C and C++, the component 'neural' of Limpid's CMake package and a
 pkg-config file.")

set(CPACK_DEBIAN_WEIGHTS_PACKAGE_NAME limpid-weights)
set(CPACK_DEBIAN_WEIGHTS_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_WEIGHTS_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_WEIGHTS_DESCRIPTION "weights of Limpid's denoising network
 Trained weights, which the program limpid and its library liblimpid-neural
 read.")

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME limpid)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "libvulkan1, limpid-weights (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS mesa-vulkan-drivers)
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "real-time path tracer and denoiser for any Vulkan device
 Renders glTF and OBJ scenes, cleans noisy EXR sequences, and compares
 pictures, on GPUs and on CPUs.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-limpid)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "liblimpid0 (= ${PROJECT_VERSION}), python3, python3-numpy")
if(TARGET limpid_neural)
  string(APPEND CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS ", liblimpid-neural0 (= ${PROJECT_VERSION})")
  get_target_property(LIMPID_NEURAL_DIR limpid_neural BINARY_DIR)  # where dpkg-shlibdeps finds it
  list(APPEND CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${LIMPID_NEURAL_DIR})
endif()
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "real-time denoisers for any Vulkan device, for Python
 NumPy arrays in, NumPy arrays out: denoises stills and sequences, renders
 scenes, and compares pictures.")
include(CPack)
