# Run when a test program is built: writes OUTPUT, which makes its suites entries of ctest. Tests of a suite share a process, the kernels that
# it compiled and its devices. No process outlives a test (LUCIOLE_HELPERS).
# PROGRAM: made with GoogleTest; APART: suites of which each test is an entry; CACHE: PoCL's.
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE list COMMAND_ERROR_IS_FATAL ANY)
# What follows a # are values of parameters.
string(REGEX REPLACE " *#[^\n]*" "" list "${list}")
string(REPLACE "\n" ";" list "${list}")
string(REPLACE "," "|" apart "${APART}")
set(entries "")
foreach(line IN LISTS list)
  set(filter "")
  if(line MATCHES "^(.+)\\.$")
    set(suite ${CMAKE_MATCH_1})
    string(REGEX MATCH "(^|/)(${apart})(/|$)" is_apart "${suite}")
    if(NOT is_apart)
      set(name ${suite})
      set(filter "${suite}.*")
    endif()
  elseif(line MATCHES "^  (.+)$" AND is_apart)
    set(name ${suite}.${CMAKE_MATCH_1})
    set(filter ${name})
  endif()
  if(filter)
    string(APPEND entries "add_test(\"${name}\" \"${PROGRAM}\" \"--gtest_filter=${filter}\")\n"
      "set_tests_properties(\"${name}\" PROPERTIES ENVIRONMENT \"POCL_CACHE_DIR=${CACHE};LUCIOLE_HELPERS=0\" FAIL_REGULAR_EXPRESSION \"Running 0 tests\"\n"
      "  SKIP_REGULAR_EXPRESSION \"PASSED  . 0 tests[.]\\n.  SKIPPED\")\n")
  endif()
endforeach()
file(WRITE ${OUTPUT} "${entries}")
