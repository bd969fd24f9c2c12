# The examples are built as a user would: against an installed Waymark, found by find_package.

file(GLOB examples CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/examples/*.cpp")
if(NOT examples)
  return()
endif()

set(prefix "${CMAKE_CURRENT_BINARY_DIR}/prefix")
set(examples_build "${CMAKE_CURRENT_BINARY_DIR}/examples")

# Without what an earlier version has installed.
add_test(NAME examples.clean COMMAND "${CMAKE_COMMAND}" -E rm -rf "${prefix}")
add_test(NAME examples.install COMMAND "${CMAKE_COMMAND}" --install "${PROJECT_BINARY_DIR}" --prefix "${prefix}")
# Nothing but Eigen and Highway is looked for where the engine alone is asked for, and nothing else is needed.
set(engine_build "${CMAKE_CURRENT_BINARY_DIR}/engine")
set(hidden "")
foreach(package IN ITEMS fmt yaml-cpp nlohmann_json ZLIB PNG JPEG BZip2 SQLite3 CLI11 OpenCV)
  list(APPEND hidden "-DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON")
endforeach()
string(REPLACE ";" "\\;" launcher "${CMAKE_CXX_COMPILER_LAUNCHER}")
set(example_settings "-DCMAKE_PREFIX_PATH=${prefix}" "-DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}"
                     "-DCMAKE_CXX_COMPILER_LAUNCHER=${launcher}" "-DCMAKE_BUILD_TYPE=${CMAKE_BUILD_TYPE}")
add_test(NAME examples.engine.configure
         COMMAND "${CMAKE_COMMAND}" -S "${PROJECT_SOURCE_DIR}/examples" -B "${engine_build}" -G "${CMAKE_GENERATOR}"
                 ${example_settings} ${hidden} -DWITH_WORKBENCH=OFF)
add_test(NAME examples.engine.build COMMAND "${CMAKE_COMMAND}" --build "${engine_build}")
add_test(NAME examples.engine.needs_nothing_else
         COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/engine_needs_test.sh" "${prefix}"
                 "${PROJECT_SOURCE_DIR}/examples/01_filter_in_your_loop.cpp")
set_tests_properties(examples.engine.configure PROPERTIES FIXTURES_REQUIRED installed FIXTURES_SETUP engine_configured)
set_tests_properties(examples.engine.build PROPERTIES FIXTURES_REQUIRED engine_configured)
set_tests_properties(examples.engine.needs_nothing_else PROPERTIES FIXTURES_REQUIRED installed)

# A component that is not there is named.
file(CONFIGURE OUTPUT "${CMAKE_CURRENT_BINARY_DIR}/missing_component/CMakeLists.txt" CONTENT
     "cmake_minimum_required(VERSION 3.22)\nproject(missing LANGUAGES CXX)\nfind_package(waymark REQUIRED COMPONENTS engine wings)\n" @ONLY)
add_test(NAME examples.missing_component
         COMMAND "${CMAKE_COMMAND}" -S "${CMAKE_CURRENT_BINARY_DIR}/missing_component" -B
                 "${CMAKE_CURRENT_BINARY_DIR}/missing_component/build" ${example_settings})
set_tests_properties(examples.missing_component PROPERTIES FIXTURES_REQUIRED installed PASS_REGULAR_EXPRESSION
                                                           "no component 'wings'")

add_test(NAME examples.configure
         COMMAND "${CMAKE_COMMAND}" -S "${PROJECT_SOURCE_DIR}/examples" -B "${examples_build}" -G "${CMAKE_GENERATOR}"
                 ${example_settings})
add_test(NAME examples.build COMMAND "${CMAKE_COMMAND}" --build "${examples_build}")
set_tests_properties(examples.clean PROPERTIES FIXTURES_SETUP cleaned)
set_tests_properties(examples.install PROPERTIES FIXTURES_REQUIRED cleaned FIXTURES_SETUP installed)
set_tests_properties(examples.configure PROPERTIES FIXTURES_REQUIRED installed FIXTURES_SETUP configured)
set_tests_properties(examples.build PROPERTIES FIXTURES_REQUIRED configured FIXTURES_SETUP examples)
set_tests_properties(
  examples.clean examples.install examples.configure examples.build examples.engine.configure examples.engine.build
  examples.engine.needs_nothing_else examples.missing_component PROPERTIES LABELS examples)

foreach(source IN LISTS examples)
  get_filename_component(example "${source}" NAME_WE)
  add_test(NAME examples.run.${example} COMMAND "${examples_build}/${example}" WORKING_DIRECTORY "${examples_build}")
  set_tests_properties(examples.run.${example} PROPERTIES FIXTURES_REQUIRED examples LABELS examples TIMEOUT 120)
endforeach()
