# Who may include what. Every library lies in /usr/include, so neither compiler nor linker notices a shortcut.
#
#   cmake -D ROOT=<source folder> -P check_includes.cmake
#
# Fails with one line per violation: file:line: the line (why not).
cmake_minimum_required(VERSION 3.25)

# forbid(WHERE <files> [UNLESS <files>] LINE <regex> [EXCEPT <regex>] BECAUSE <why>): in these files no line may match,
# except ... Files are regular expressions on paths relative to ROOT.
function(forbid)
  cmake_parse_arguments(PARSE_ARGV 0 rule "" "WHERE;UNLESS;LINE;EXCEPT;BECAUSE" "")
  foreach(file IN LISTS sources)
    if(NOT file MATCHES "${rule_WHERE}" OR (rule_UNLESS AND file MATCHES "${rule_UNLESS}"))
      continue()
    endif()
    foreach(number_and_line IN LISTS "lines_of_${file}")
      string(REGEX REPLACE "^[0-9]+:" "" line "${number_and_line}")
      if(line MATCHES "${rule_LINE}" AND NOT (rule_EXCEPT AND line MATCHES "${rule_EXCEPT}"))
        list(APPEND violations "${file}:${number_and_line}  (${rule_BECAUSE})")
      endif()
    endforeach()
  endforeach()
  set(violations "${violations}" PARENT_SCOPE)
endfunction()

# Read every source once. Semicolons and brackets would split or join CMake's lists; no rule needs them. Comments go too.
file(GLOB_RECURSE sources RELATIVE "${ROOT}" "${ROOT}/core/*.h" "${ROOT}/core/*.cpp" "${ROOT}/plugin/*.h"
     "${ROOT}/plugin/*.cpp" "${ROOT}/tools/*.h" "${ROOT}/tools/*.cpp" "${ROOT}/tests/core/*.h" "${ROOT}/tests/core/*.cpp")
list(SORT sources)
foreach(file IN LISTS sources)
  file(READ "${ROOT}/${file}" text)
  string(REGEX REPLACE "[][;]" " " text "${text}")
  string(REPLACE "\\" " " text "${text}")
  string(REPLACE "\n" ";" text "${text}")
  set(number 0)
  foreach(line IN LISTS text)
    math(EXPR number "${number} + 1")
    string(REGEX REPLACE "//.*" "" code "${line}")
    string(STRIP "${code}" code)
    if(code)
      list(APPEND "lines_of_${file}" "${number}:${code}")
    endif()
  endforeach()
endforeach()
list(LENGTH sources source_count)
if(source_count EQUAL 0)
  message(FATAL_ERROR "no sources below ${ROOT}")
endif()

set(include "^# *include *[<\"]")
set(gltf_libraries "(tiny_gltf|draco/|nlohmann/|meshoptimizer|png\\.h|jpeglib|webp/)")
set(printing_headers "(iostream|cstdio|stdio\\.h|print)")

# Dependencies point one way: tools -> plugin -> core.
forbid(WHERE "^core/" LINE "${include}(plugin|tools|tests)/" BECAUSE "core stands below plugin and tools")
forbid(WHERE "^plugin/" LINE "${include}(tools|tests)/" BECAUSE "plugin stands below tools")
forbid(WHERE "^tools/" LINE "${include}(core|plugin|tests)/" EXCEPT "${include}plugin/(gltf_radiosity|relight|verify|view|whole_file|result)\\.h"
       BECAUSE "tools use the public API only")
forbid(WHERE "^tests/core/" LINE "${include}(plugin|tools)/" BECAUSE "the tests of core need nothing above it")

# core: no files, no glTF, no printing.
forbid(WHERE "^core/" LINE "${include}${gltf_libraries}" BECAUSE "core knows no file formats")
forbid(WHERE "^core/" LINE "${include}(${printing_headers}|fstream|filesystem)" BECAUSE "core neither prints nor reads files")
forbid(WHERE "^core/" LINE "${include}(CLI|fmt)/" BECAUSE "core neither prints nor parses options")
set(openmesh_doors "^core/mesh/(openmesh_bridge|collapse_net)\\.cpp$")
forbid(WHERE "^core/" UNLESS "(${openmesh_doors}|^core/mesh/openmesh_join\\.h$)" LINE "${include}OpenMesh/"
       BECAUSE "core/mesh/openmesh_bridge.cpp and core/mesh/collapse_net.cpp are the only doors to OpenMesh")
forbid(WHERE "." UNLESS "${openmesh_doors}" LINE "${include}core/mesh/openmesh_join\\.h" BECAUSE "it brings OpenMesh along")
forbid(WHERE "^core/" UNLESS "^core/visibility/" LINE "${include}embree" BECAUSE "rays belong to core/visibility")

forbid(WHERE "^(core|tests/core)/" LINE "std::atomic(<| |_flag)"
       BECAUSE "tests/core/tsan_suppressions.txt leaves out what these do, for oneTBB's headers have some; atomic_ref is looked at")

# plugin: the only code that knows tinygltf and Draco; it does not print.
forbid(WHERE "^(plugin|tools)/" LINE "${include}(OpenMesh/|embree)" BECAUSE "meshes and rays belong to core")
forbid(WHERE "^(tools|tests/core)/" LINE "${include}${gltf_libraries}" BECAUSE "glTF's libraries belong to plugin")
forbid(WHERE "^plugin/" LINE "${include}(CLI/|iostream)" BECAUSE "only tools print and parse options")
forbid(WHERE "^(core|plugin)/" LINE "(std::(cout|cerr|clog)|(^|[^_a-z])(f?printf|f?puts|exit|abort) *\\()"
       BECAUSE "only tools print and exit")

# The public headers: the standard library and each other, so that they can be installed as they are.
set(public_headers "^plugin/(gltf_radiosity|relight|verify|view|whole_file|result)\\.h$")
forbid(WHERE "${public_headers}" LINE "^# *include" EXCEPT "${include}([a-z_]+>|(gltf_radiosity|relight|verify|view|result)\\.h\")"
       BECAUSE "public headers include the standard library and each other")

# One way to write an include. One pi between luminance and radiosity; angles are measured with another, at these doors.
forbid(WHERE "." UNLESS "${public_headers}" LINE "^# *include *\"" EXCEPT "\"(core|plugin|tools|tests)/"
       BECAUSE "our headers are included by their path from the top")
forbid(WHERE "^(core|plugin|tools)/" UNLESS "^(core/photometry\\.h|core/visibility/hemicube\\.cpp|core/sky\\.cpp|plugin/import_lights\\.cpp)$"
       LINE "(numbers::pi|M_PI|3\\.14159)"
       BECAUSE "core/photometry.h is the only place with a pi")

if(violations)
  list(JOIN violations "\n  " violations)
  message(FATAL_ERROR "forbidden:\n  ${violations}")
endif()
message(STATUS "${source_count} sources keep to the architecture")
