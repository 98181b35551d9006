# cmake --install: the program, the static library, its headers and a package for
# find_package(vdbeam), which defines vdbeam::vdbeam.
include(CMakePackageConfigHelpers)
set(vdbeam_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/vdbeam)

if(TARGET vdbeam_cli)
  install(TARGETS vdbeam_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
install(TARGETS vdbeam EXPORT vdbeamTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/vdbeam DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

install(EXPORT vdbeamTargets NAMESPACE vdbeam:: DESTINATION ${vdbeam_package_dir})
configure_package_config_file(cmake/vdbeamConfig.cmake.in
  ${PROJECT_BINARY_DIR}/generated/vdbeamConfig.cmake INSTALL_DESTINATION ${vdbeam_package_dir}
  NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/generated/vdbeamConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/generated/vdbeamConfig.cmake
              ${PROJECT_BINARY_DIR}/generated/vdbeamConfigVersion.cmake
              cmake/VdbeamLibraries.cmake
        DESTINATION ${vdbeam_package_dir})
