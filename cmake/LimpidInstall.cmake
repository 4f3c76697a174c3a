# Installation rules. Each component is also a Debian package (LimpidPackages.cmake):
# - library: liblimpid.so.0; development: its headers, CMake package and pkg-config file;
# - neural and neural_development: the same for liblimpid-neural.so.0; shot and shot_development: for
#   liblimpid-shot.so.0; weights: the network's weights;
# - program: limpid; mpi: its module for clusters (src/cluster); python: the Python package.
include(CMakePackageConfigHelpers)
find_program(LIMPID_GZIP gzip REQUIRED)

set(LIMPID_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/limpid)

install(TARGETS limpid_denoise EXPORT limpidTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/limpid DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  COMPONENT development FILES_MATCHING PATTERN "*.h" PATTERN "*.hpp" PATTERN "neural.*" EXCLUDE
  PATTERN "shot.*" EXCLUDE)

# For find_package(limpid).
install(EXPORT limpidTargets NAMESPACE limpid:: DESTINATION ${LIMPID_CMAKE_DIR} COMPONENT development)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/limpidConfig.cmake.in
  ${PROJECT_BINARY_DIR}/install/limpidConfig.cmake INSTALL_DESTINATION ${LIMPID_CMAKE_DIR}
  NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/install/limpidConfigVersion.cmake
  COMPATIBILITY SameMajorVersion)
install(FILES ${PROJECT_BINARY_DIR}/install/limpidConfig.cmake ${PROJECT_BINARY_DIR}/install/limpidConfigVersion.cmake
  DESTINATION ${LIMPID_CMAKE_DIR} COMPONENT development)

# The program looks for KPCN's weights in ../share/limpid, the library in the folder that
# src/denoise/api/network/CMakeLists.txt sets. Those of nano are part of the programs and libraries.
if(LIMPID_APPS OR TARGET limpid_neural)
  install(FILES ${PROJECT_SOURCE_DIR}/weights/kpcn.safetensors ${PROJECT_SOURCE_DIR}/weights/kpcn-cis565.safetensors
    DESTINATION ${CMAKE_INSTALL_DATADIR}/limpid COMPONENT weights)
endif()

# For pkg-config. Paths in the .pc file are relative to its own folder, so that the prefix can be moved.
file(RELATIVE_PATH LIMPID_PREFIX_FROM_PC
  ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
# limpid_install_pc(NAME DESCRIPTION COMPONENT): installs NAME.pc for libNAME.so.
function(limpid_install_pc NAME DESCRIPTION COMPONENT)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/limpid.pc.in ${PROJECT_BINARY_DIR}/install/${NAME}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/install/${NAME}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
    COMPONENT ${COMPONENT})
endfunction()
limpid_install_pc(limpid "Real-time denoisers for any Vulkan device" development)

# limpid_install_extra(NAME TARGETS DESCRIPTION): installs liblimpid-NAME with its headers. limpidConfig.cmake includes
# TARGETS.cmake if it is in the same folder.
function(limpid_install_extra NAME TARGETS DESCRIPTION)
  install(TARGETS limpid_${NAME} EXPORT ${TARGETS}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${NAME} NAMELINK_COMPONENT ${NAME}_development)
  install(FILES ${PROJECT_SOURCE_DIR}/include/limpid/${NAME}.h ${PROJECT_SOURCE_DIR}/include/limpid/${NAME}.hpp
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/limpid COMPONENT ${NAME}_development)
  install(EXPORT ${TARGETS} NAMESPACE limpid:: DESTINATION ${LIMPID_CMAKE_DIR} COMPONENT ${NAME}_development)
  limpid_install_pc(limpid-${NAME} "${DESCRIPTION}" ${NAME}_development)
endfunction()
if(TARGET limpid_neural)
  limpid_install_extra(neural limpidNeuralTargets "Kernel-predicting denoising network for any Vulkan device")
endif()
if(TARGET limpid_shot)
  limpid_install_extra(shot limpidShotTargets "Denoising of other renderers' EXR files on any Vulkan device")
endif()
