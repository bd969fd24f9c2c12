# The examples are built as a user would: against an installed Waymark, found by find_package.

file(GLOB examples CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/examples/*.cpp")
if(NOT examples)
  return()
endif()

set(prefix "${CMAKE_CURRENT_BINARY_DIR}/prefix")
set(examples_build "${CMAKE_CURRENT_BINARY_DIR}/examples")

add_test(NAME examples.install COMMAND "${CMAKE_COMMAND}" --install "${PROJECT_BINARY_DIR}" --prefix "${prefix}")
add_test(NAME examples.configure
         COMMAND "${CMAKE_COMMAND}" -S "${PROJECT_SOURCE_DIR}/examples" -B "${examples_build}" -G "${CMAKE_GENERATOR}"
                 "-DCMAKE_PREFIX_PATH=${prefix}" "-DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}"
                 "-DCMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER}" "-DCMAKE_BUILD_TYPE=${CMAKE_BUILD_TYPE}")
add_test(NAME examples.build COMMAND "${CMAKE_COMMAND}" --build "${examples_build}")
set_tests_properties(examples.install PROPERTIES FIXTURES_SETUP installed)
set_tests_properties(examples.configure PROPERTIES FIXTURES_REQUIRED installed FIXTURES_SETUP configured)
set_tests_properties(examples.build PROPERTIES FIXTURES_REQUIRED configured FIXTURES_SETUP examples)
set_tests_properties(examples.install examples.configure examples.build PROPERTIES LABELS examples)

foreach(source IN LISTS examples)
  get_filename_component(example "${source}" NAME_WE)
  add_test(NAME examples.run.${example} COMMAND "${examples_build}/${example}" WORKING_DIRECTORY "${examples_build}")
  set_tests_properties(examples.run.${example} PROPERTIES FIXTURES_REQUIRED examples LABELS examples TIMEOUT 120)
endforeach()
