# cmake --install: the program with its manual page, completions, documentation, sample scenes, Blender add-on and USD
# converter; the static library, its headers and a package for find_package(vdbeam), which defines vdbeam::vdbeam.
include(CMakePackageConfigHelpers)
set(vdbeam_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/vdbeam)

set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME development)

if(TARGET vdbeam_cli)
  install(TARGETS vdbeam_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)

  # The program writes its own manual page and completions, so that they cannot differ from --help.
  set(pages ${PROJECT_BINARY_DIR}/generated/pages)
  file(MAKE_DIRECTORY ${pages})
  add_custom_command(OUTPUT ${pages}/vdbeam.1 ${pages}/vdbeam ${pages}/_vdbeam
    COMMAND vdbeam_cli generate man > ${pages}/vdbeam.1
    COMMAND vdbeam_cli generate bash > ${pages}/vdbeam
    COMMAND vdbeam_cli generate zsh > ${pages}/_vdbeam
    DEPENDS vdbeam_cli VERBATIM)
  add_custom_target(vdbeam_pages ALL DEPENDS ${pages}/vdbeam.1 ${pages}/vdbeam ${pages}/_vdbeam)
  install(FILES ${pages}/vdbeam.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
  install(FILES ${pages}/vdbeam COMPONENT program
          DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
  # Debian's zsh looks for the completions of packages in a folder of their own.
  install(CODE "
    set(folder site-functions)
    if(CMAKE_INSTALL_PREFIX STREQUAL \"/usr\")
      set(folder vendor-completions)
    endif()
    file(INSTALL \"${pages}/_vdbeam\"
         DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/zsh/\${folder}\")"
    COMPONENT program)

  install(FILES README.md CHANGELOG.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR}
          COMPONENT program)
  install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
  install(DIRECTORY data/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples COMPONENT program
          PATTERN reference EXCLUDE PATTERN gallery EXCLUDE)

  # The converter imports what it shares with the add-on from the zip beside it.
  find_package(Python3 COMPONENTS Interpreter)
  if(Python3_FOUND)
    set(addon ${PROJECT_BINARY_DIR}/generated/vdbeam_blender.zip)
    set(make_zip ${PROJECT_SOURCE_DIR}/tools/blender/make_zip.py)
    file(GLOB addon_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tools/blender/vdbeam_blender/*.py)
    add_custom_command(OUTPUT ${addon} COMMAND ${Python3_EXECUTABLE} -B ${make_zip} ${addon}
                       DEPENDS ${make_zip} ${addon_sources} VERBATIM)
    add_custom_target(vdbeam_blender_zip ALL DEPENDS ${addon})
    set(folder ${CMAKE_INSTALL_DATADIR}/vdbeam)
    install(FILES ${addon} DESTINATION ${folder} COMPONENT program)
    install(PROGRAMS tools/usd2vdbeam.py DESTINATION ${folder} COMPONENT program)
    install(DIRECTORY tools/usd_scene DESTINATION ${folder} COMPONENT program FILES_MATCHING PATTERN *.py
            PATTERN __pycache__ EXCLUDE)
  else()
    message(STATUS "The Blender add-on and the USD converter are not installed: Python is missing")
  endif()
endif()
install(TARGETS vdbeam EXPORT vdbeamTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/vdbeam DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

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

if(PROJECT_IS_TOP_LEVEL AND TARGET vdbeam_cli)
  include(VdbeamPackage)
endif()
