# The Python module: build/.../python/vdbeam is a package that PYTHONPATH=build/.../python finds. It is
# left out, with a line that says so, where pybind11 or Python's headers are missing.
if(NOT VDBEAM_BUILD_PYTHON OR VDBEAM_SANITIZE) # a sanitizer would have to be in Python, too
  return()
endif()
set(PYBIND11_FINDPYTHON ON)
find_package(Python 3.9 COMPONENTS Interpreter Development.Module)
if(Python_Development.Module_FOUND)
  find_package(pybind11 CONFIG)
endif()
if(NOT pybind11_FOUND)
  message(STATUS "The Python module is left out: pybind11-dev or python3-dev is missing")
  return()
endif()

file(GLOB VDBEAM_PYTHON_SOURCES CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/python/*.cpp)
pybind11_add_module(vdbeam_python NO_EXTRAS ${VDBEAM_PYTHON_SOURCES})
set(vdbeam_python_package ${PROJECT_BINARY_DIR}/python/vdbeam)
set_target_properties(vdbeam_python PROPERTIES OUTPUT_NAME _core LIBRARY_OUTPUT_DIRECTORY
                      ${vdbeam_python_package} CXX_VISIBILITY_PRESET hidden)
target_include_directories(vdbeam_python PRIVATE src)
target_link_libraries(vdbeam_python PRIVATE vdbeam_options vdbeam nlohmann_json::nlohmann_json)
# Only the entry point is exported. Templates of OpenVDB that this library has instantiated would else
# replace some of those in libopenvdb, whose other statics they do not know.
target_link_options(vdbeam_python PRIVATE -Wl,--exclude-libs,ALL)
target_compile_options(vdbeam_python PRIVATE ${VDBEAM_LIGHT_OPTIMISATION})

# The package's own files are linked to, so that an edit needs no build.
file(MAKE_DIRECTORY ${vdbeam_python_package})
file(GLOB VDBEAM_PYTHON_FILES CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/python/vdbeam/*)
foreach(file ${VDBEAM_PYTHON_FILES})
  get_filename_component(name ${file} NAME)
  if(NOT IS_DIRECTORY ${file})
    file(CREATE_LINK ${file} ${vdbeam_python_package}/${name} SYMBOLIC)
  endif()
endforeach()

# Where Python looks is only known when the prefix is: Debian's Python reads dist-packages, which have no
# version in /usr.
set(vdbeam_python_version ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR})
install(CODE "
  set(folder lib/python${vdbeam_python_version}/site-packages)
  if(CMAKE_INSTALL_PREFIX STREQUAL \"/usr\")
    set(folder lib/python3/dist-packages)
  elseif(CMAKE_INSTALL_PREFIX STREQUAL \"/usr/local\" AND EXISTS /etc/debian_version)
    set(folder lib/python${vdbeam_python_version}/dist-packages)
  endif()
  file(INSTALL ${VDBEAM_PYTHON_FILES} \"$<TARGET_FILE:vdbeam_python>\"
       DESTINATION \"\${CMAKE_INSTALL_PREFIX}/\${folder}/vdbeam\")"
  COMPONENT python)
