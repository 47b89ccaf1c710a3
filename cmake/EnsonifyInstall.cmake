# find_package(ensonify REQUIRED) gives ensonify::core ... ensonify::generators, see tests/install for a user.
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/ensonify)

# What links ensonify_output needs OpenVDB too where the build found it.
set_target_properties(ensonify_openvdb PROPERTIES EXPORT_NAME openvdb)
install(TARGETS ensonify_openvdb EXPORT ensonify)
install(EXPORT ensonify NAMESPACE ensonify:: FILE ensonifyTargets.cmake DESTINATION ${package_folder})

set(ENSONIFY_DATA_DIR ${CMAKE_INSTALL_DATADIR}/ensonify)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/ensonifyConfig.cmake.in
  ${PROJECT_BINARY_DIR}/ensonifyConfig.cmake INSTALL_DESTINATION ${package_folder} PATH_VARS ENSONIFY_DATA_DIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/ensonifyConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/ensonifyConfig.cmake
  ${PROJECT_BINARY_DIR}/ensonifyConfigVersion.cmake
  ${PROJECT_SOURCE_DIR}/cmake/FindOneDNN.cmake
  ${PROJECT_SOURCE_DIR}/cmake/FindOpenCVModules.cmake
  ${PROJECT_SOURCE_DIR}/cmake/ensonify_data_folder.cpp.in
  DESTINATION ${package_folder})
