# What the built program answers to the shell: exit code, and who gets how many lines. Needs no scene.
#
#   cmake -D PROGRAM=<gltf-radiosity> -D SCRATCH=<folder> -P exit_codes_test.cmake
cmake_minimum_required(VERSION 3.25)

# expect(CODE <exit code> STDOUT <regex> STDERR <regex> ARGUMENTS <...>)
function(expect)
  cmake_parse_arguments(PARSE_ARGV 0 wanted "" "CODE;STDOUT;STDERR" "ARGUMENTS")
  execute_process(COMMAND ${PROGRAM} ${wanted_ARGUMENTS} WORKING_DIRECTORY ${SCRATCH}
                  RESULT_VARIABLE code OUTPUT_VARIABLE stdout ERROR_VARIABLE stderr)
  if(NOT code STREQUAL wanted_CODE OR NOT stdout MATCHES "${wanted_STDOUT}" OR NOT stderr MATCHES "${wanted_STDERR}")
    message(SEND_ERROR "${wanted_ARGUMENTS}\nexit code ${code}, not ${wanted_CODE}\nstdout: ${stdout}\nstderr: ${stderr}")
  endif()
endfunction()

set(one_error "^gltf-radiosity: error: [^\n]+\n$")
set(scene ${SCRATCH}/exit_codes_test.gltf)
file(WRITE ${scene} "this is no glTF")

# People who ask get answers on stdout.
expect(CODE 0 STDOUT "^Bakes .*Usage: gltf-radiosity IN OUT" STDERR "^$" ARGUMENTS --help)
expect(CODE 0 STDOUT "^gltf-radiosity [0-9]+\\.[0-9]+\\.[0-9]+\n$" STDERR "^$" ARGUMENTS --version)

expect(CODE 0 STDOUT "^Says .*Usage: gltf-radiosity verify IN OUT" STDERR "^$" ARGUMENTS verify --help)
expect(CODE 0 STDOUT "^Makes .*Usage: gltf-radiosity view OUT --html FILE" STDERR "^$" ARGUMENTS view --help)

# Wrong usage: one line, and nothing on stdout.
expect(CODE 2 STDOUT "^$" STDERR "${one_error}")
expect(CODE 2 STDOUT "^$" STDERR "${one_error}" ARGUMENTS ${scene} out.glb --hemicube 3)
expect(CODE 2 STDOUT "^$" STDERR "${one_error}" ARGUMENTS ${scene} out.glb --no-such-option)
expect(CODE 2 STDOUT "^$" STDERR "${one_error}" ARGUMENTS ${scene} out.glb --sky 1,nan,1)

expect(CODE 2 STDOUT "^$" STDERR "${one_error}" ARGUMENTS verify)
expect(CODE 2 STDOUT "^$" STDERR "${one_error}" ARGUMENTS view ${scene})
expect(CODE 2 STDOUT "^$" STDERR "${one_error}" ARGUMENTS verify ${scene} out.glb --hemicube 16)

# Bad input: one line that names the file, a report on request, no output.
expect(CODE 1 STDOUT "^$" STDERR "${one_error}" ARGUMENTS ${scene} out.glb --progress none)
expect(CODE 1 STDOUT "^$" STDERR "${one_error}" ARGUMENTS no_such_file.glb out.glb --progress none)
expect(CODE 1 STDOUT "\"code\": \"bad-input\"" STDERR "${one_error}" ARGUMENTS ${scene} out.glb --progress none --json -)
expect(CODE 1 STDOUT "^$" STDERR "${one_error}" ARGUMENTS verify ${scene} out.glb --progress none)
expect(CODE 1 STDOUT "^$" STDERR "${one_error}" ARGUMENTS view ${scene} --html out.html --progress none)
expect(CODE 1 STDOUT "\"code\": \"bad-input\"" STDERR "${one_error}"
       ARGUMENTS verify ${scene} out.glb --progress none --json -)
if(EXISTS ${SCRATCH}/out.glb)
  message(SEND_ERROR "out.glb was written")
endif()
file(REMOVE ${scene})
