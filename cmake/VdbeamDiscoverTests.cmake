# Lists the tests of a gtest program for CTest: one entry for each suite, and one for each test that is slow.
#
# A process for each test would cost more than most tests do, since each start loads OpenVDB. The output of a
# suite names the test that failed, and the last one that began where the program crashed.
#
# Included by CMakeLists.txt it defines vdbeam_discover_tests(); as a script (cmake -P) it writes the file of tests
# after each build of the program.

# vdbeam_discover_tests(TARGET LABEL): the tests are named LABEL.SUITE, or LABEL.SUITE.TEST where "Slow" is in the name.
# These have the label "slow" as well and their own entry, so that they begin first and run beside others.
function(vdbeam_discover_tests target label)
  set(script ${PROJECT_SOURCE_DIR}/cmake/VdbeamDiscoverTests.cmake)
  set(list ${CMAKE_CURRENT_BINARY_DIR}/${target}_suites.cmake)
  add_custom_command(TARGET ${target} POST_BUILD VERBATIM BYPRODUCTS ${list}
    COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:${target}> -DLABEL=${label} -DLIST=${list}
            -P ${script})
  set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${script})
  set(include ${CMAKE_CURRENT_BINARY_DIR}/${target}_include.cmake)
  file(WRITE ${include} "if(EXISTS \"${list}\")\n  include(\"${list}\")\nelse()\n"
       "  add_test(${label}.not_built ${target})\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${include})
endfunction()

if(NOT CMAKE_SCRIPT_MODE_FILE)
  return()
endif()

execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE lines TIMEOUT 60
                COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE "  # [^\n]*" "" lines "${lines}") # types and values of parameters
string(REPLACE "\n" ";" lines "${lines}")
set(text "")

# add_entry(NAME FILTER LABELS PROPERTIES): adds an entry for the tests that a filter selects.
macro(add_entry name filter labels properties)
  string(APPEND text "add_test([[${LABEL}.${name}]] [[${PROGRAM}]] [[--gtest_filter=${filter}]])\n"
         "set_tests_properties([[${LABEL}.${name}]] PROPERTIES LABELS [[${labels}]] TIMEOUT 600 ${properties} "
         # A filter that selects nothing would pass.
         "FAIL_REGULAR_EXPRESSION [[Running 0 tests]])\n")
endmacro()

foreach(line IN LISTS lines)
  if(line MATCHES "^([^ ]+)\\.$")
    set(suite ${CMAKE_MATCH_1})
    set(is_listed FALSE)
  elseif(line MATCHES "^  ([^ ]+)$")
    set(test ${suite}.${CMAKE_MATCH_1})
    if(test MATCHES "Slow")
      add_entry(${test} ${test} "${LABEL};slow" "COST 20")
    elseif(NOT is_listed)
      add_entry(${suite} ${suite}.*-*Slow* ${LABEL} "")
      set(is_listed TRUE)
    endif()
  endif()
endforeach()
file(WRITE ${LIST} "${text}")
