# What `cmake --install` puts where. Its components are also the Debian packages (LimpidPackages.cmake):
# library: liblimpid.so.0; development: headers, CMake package, pkg-config; program: limpid and its weights.
include(CMakePackageConfigHelpers)

set(LIMPID_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/limpid)

install(TARGETS limpid_denoise EXPORT limpidTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/limpid DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  COMPONENT development FILES_MATCHING PATTERN "*.h" PATTERN "*.hpp")

# find_package(limpid)
install(EXPORT limpidTargets NAMESPACE limpid:: DESTINATION ${LIMPID_CMAKE_DIR} COMPONENT development)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/limpidConfig.cmake.in
  ${PROJECT_BINARY_DIR}/install/limpidConfig.cmake INSTALL_DESTINATION ${LIMPID_CMAKE_DIR}
  NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/install/limpidConfigVersion.cmake
  COMPATIBILITY SameMajorVersion)
install(FILES ${PROJECT_BINARY_DIR}/install/limpidConfig.cmake ${PROJECT_BINARY_DIR}/install/limpidConfigVersion.cmake
  DESTINATION ${LIMPID_CMAKE_DIR} COMPONENT development)

# pkg-config: its paths follow from where limpid.pc lies, so that a moved prefix still works.
file(RELATIVE_PATH LIMPID_PREFIX_FROM_PC
  ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
configure_file(${PROJECT_SOURCE_DIR}/cmake/limpid.pc.in ${PROJECT_BINARY_DIR}/install/limpid.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/install/limpid.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
  COMPONENT development)
