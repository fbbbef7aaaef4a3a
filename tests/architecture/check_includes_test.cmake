# check_includes.cmake must find every line of samples/ that ends in "// forbidden", and no other.
cmake_minimum_required(VERSION 3.25)
set(samples ${CMAKE_CURRENT_LIST_DIR}/samples)

# What the samples say.
file(GLOB_RECURSE files RELATIVE ${samples} ${samples}/*.h ${samples}/*.cpp)
foreach(file IN LISTS files)
  file(READ ${samples}/${file} text)
  string(REPLACE ";" " " text "${text}")
  string(REPLACE "\n" ";" text "${text}")
  set(number 0)
  foreach(line IN LISTS text)
    math(EXPR number "${number} + 1")
    if(line MATCHES "// forbidden$")
      list(APPEND expected "${file}:${number}")
    endif()
  endforeach()
endforeach()

# What the check says.
execute_process(COMMAND ${CMAKE_COMMAND} -D ROOT=${samples} -P ${CMAKE_CURRENT_LIST_DIR}/check_includes.cmake
                RESULT_VARIABLE result ERROR_VARIABLE report OUTPUT_QUIET)
string(REGEX MATCHALL "[a-z_/]+\\.(cpp|h):[0-9]+:" found "${report}")
list(TRANSFORM found REPLACE ":$" "")
list(REMOVE_DUPLICATES found)

list(SORT expected)
list(SORT found)
list(LENGTH expected expected_count)
if(result EQUAL 0 OR expected_count LESS 20 OR NOT found STREQUAL expected)
  message(FATAL_ERROR "expected: ${expected}\nfound:    ${found}\n${report}")
endif()
message(STATUS "${expected_count} violations found")
