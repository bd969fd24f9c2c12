# A folder of waymark/ (the engine) or workbench/ is one static library with one include directory of its own, so that an
# #include of a folder that it does not depend on does not compile.

# waymark_add_folders(<floor> <folders...>): adds the folders of a floor, which is a directory, in that order.
function(waymark_add_folders floor)
  foreach(name IN LISTS ARGN)
    add_subdirectory("${PROJECT_SOURCE_DIR}/${floor}/${name}" "${PROJECT_BINARY_DIR}/folders/${name}")
  endforeach()
endfunction()

# waymark_folder(<name>
#   SOURCES <files...>
#   DEPENDS <folders before this one...>
#   LIBRARIES <imported targets that the headers need...>
#   PRIVATE_LIBRARIES <imported targets that only the sources need...>
#   BATCH <number of files>
#   ALONE <files...>
#   RUNS_ONCE)
# With RUNS_ONCE it is little optimised, because compiling it would take longer than that saves. Makes the library waymark_<name>, known as waymark::<name>.
function(waymark_folder name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "RUNS_ONCE" "BATCH" "SOURCES;DEPENDS;LIBRARIES;PRIVATE_LIBRARIES;ALONE")
  waymark_check_arguments("waymark_folder(${name})")
  waymark_check_order(${name} "${arg_DEPENDS}")

  cmake_path(GET CMAKE_CURRENT_SOURCE_DIR PARENT_PATH floor)
  cmake_path(GET floor FILENAME floor)
  set(include_dir "${PROJECT_BINARY_DIR}/include/${name}")
  file(MAKE_DIRECTORY "${include_dir}/${floor}")
  file(CREATE_LINK "${CMAKE_CURRENT_SOURCE_DIR}" "${include_dir}/${floor}/${name}" SYMBOLIC)

  set(target waymark_${name})
  add_library(${target} STATIC ${arg_SOURCES})
  add_library(waymark::${name} ALIAS ${target})
  target_include_directories(
    ${target} PUBLIC $<BUILD_INTERFACE:${include_dir}> $<INSTALL_INTERFACE:${WAYMARK_INSTALL_INCLUDE_${floor}}>)
  target_compile_features(${target} PUBLIC cxx_std_20)
  list(TRANSFORM arg_DEPENDS PREPEND waymark:: OUTPUT_VARIABLE folders)
  target_link_libraries(${target} PUBLIC ${folders} ${arg_LIBRARIES} PRIVATE ${arg_PRIVATE_LIBRARIES})
  waymark_warnings(${target})
  waymark_batch(${target} "${arg_BATCH}" "${arg_ALONE}")
  if(arg_RUNS_ONCE)
    waymark_runs_once(${target})
  endif()
  waymark_record_reach(${name} "${arg_DEPENDS}")
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} WAYMARK_FLOOR ${floor})
  set_property(GLOBAL APPEND PROPERTY WAYMARK_ADDED_FOLDERS ${name})
endfunction()

# waymark_module(<name> FOLDER <folder> SOURCES <files...> LIBRARIES <imported targets...>)
# The module waymark-<name>.so, which load_module() of workbench/config/module.hpp opens: at the top of the build tree, beside
# the programs, and installed in lib/waymark/. It includes what <folder> can, but is linked with headers only: what is not
# inline is in the program that loads it. Its target is waymark_module_<name>.
function(waymark_module name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "FOLDER" "SOURCES;LIBRARIES")
  waymark_check_arguments("waymark_module(${name})")
  set(target waymark_module_${name})
  add_library(${target} MODULE ${arg_SOURCES})
  set_target_properties(
    ${target}
    PROPERTIES OUTPUT_NAME waymark-${name}
               PREFIX ""
               SUFFIX .so
               LIBRARY_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}"
               CXX_VISIBILITY_PRESET hidden
               VISIBILITY_INLINES_HIDDEN ON)
  target_include_directories(${target}
                             PRIVATE $<TARGET_PROPERTY:waymark_${arg_FOLDER},INTERFACE_INCLUDE_DIRECTORIES>)
  target_compile_definitions(${target} PRIVATE WAYMARK_VERSION="${PROJECT_VERSION}")
  target_link_libraries(${target} PRIVATE ${arg_LIBRARIES})
  waymark_warnings(${target})
  install(TARGETS ${target} LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}/waymark")
endfunction()

# waymark_program(<name> SOURCES <files...> DEPENDS <folders...> LIBRARIES <imported targets...> BATCH <number of files>
#   ALONE <files...>)
# A program that lands at the top of the build tree; its target is waymark_program_<name>.
function(waymark_program name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "BATCH" "SOURCES;DEPENDS;LIBRARIES;ALONE")
  waymark_check_arguments("waymark_program(${name})")
  set(target waymark_program_${name})
  add_executable(${target} ${arg_SOURCES})
  set_target_properties(${target} PROPERTIES OUTPUT_NAME ${name} RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}")
  waymark_batch(${target} "${arg_BATCH}" "${arg_ALONE}")
  waymark_link(${target} "${arg_DEPENDS}" "${arg_LIBRARIES}")
endfunction()

# waymark_test(<folder> FILES <files...> LIBRARIES <further targets...> BATCH <number of files> ALONE <files...>
#   SLOW <gtest filters...> THREADED <files...>)
# One GoogleTest program for tests/<folder>/; its tests appear in ctest as <folder>.<suite>.<test>, labelled <folder>.
# Those that match SLOW take seconds each, most because they are statistics over many runs: they are <folder>.slow.<suite>.<test>,
# and not run under sanitizers. There a program is one test, because starting it takes longer than most of its tests.
# The sanitizer of threads gets only what is tested on several threads, the files that THREADED names.
function(waymark_test folder)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "BATCH" "FILES;LIBRARIES;ALONE;SLOW;THREADED")
  waymark_check_arguments("waymark_test(${folder})")
  set(target waymark_${folder}_test)
  if(WAYMARK_SANITIZE STREQUAL "thread")
    if(NOT arg_THREADED)
      return()
    endif()
    set(arg_FILES ${arg_THREADED})
  endif()
  add_executable(${target} ${arg_FILES})
  waymark_runs_once(${target})
  waymark_batch(${target} "${arg_BATCH}" "${arg_ALONE}")
  waymark_link(${target} "${folder}" "waymark_test_support;${arg_LIBRARIES}")
  list(JOIN arg_SLOW ":" slow)
  if(WAYMARK_SANITIZE)
    add_test(NAME ${folder} COMMAND ${target} --gtest_brief=1 "--gtest_filter=-${slow}")
    set_tests_properties(${folder} PROPERTIES TIMEOUT 1200 LABELS ${folder})
    return()
  endif()
  waymark_discover_tests(${target} ${folder} "-${slow}" "")
  if(slow)
    waymark_discover_tests(${target} ${folder} "${slow}" "slow.")
  endif()
endfunction()

# Those of a test program that match a filter, under names with a mark.
function(waymark_discover_tests target folder filter mark)
  gtest_discover_tests(
    ${target}
    TEST_FILTER "${filter}"
    TEST_PREFIX "${folder}.${mark}"
    DISCOVERY_MODE PRE_TEST
    PROPERTIES TIMEOUT 300 LABELS "${folder}")
endfunction()

# waymark_bench(<folder> FILES <files...> LIBRARIES <further targets...>): one Google Benchmark program.
function(waymark_bench folder)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "FILES;LIBRARIES")
  waymark_check_arguments("waymark_bench(${folder})")
  set(target waymark_${folder}_bench)
  add_executable(${target} ${arg_FILES})
  waymark_link(${target} "${folder}" "benchmark::benchmark_main;${arg_LIBRARIES}")
endfunction()

# Where CMAKE_UNITY_BUILD is on, so many files of the target (BATCH, 8 unless given) go to the compiler at once, which reads
# what they all include only once; those named ALONE do not. Larger batches are quicker, but no compiler process may need
# more than 700 MB, so that two fit into small machines: scripts/measure_build.sh.
function(waymark_batch target files alone)
  if(NOT files)
    set(files 8)
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE ${files})
  if(alone)
    set_source_files_properties(${alone} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
endfunction()

# Compiles a target with few optimisations.
function(waymark_runs_once target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# Links a program with those of the named folders that exist, and with other targets.
function(waymark_link target folders libraries)
  foreach(folder IN LISTS folders)
    if(TARGET waymark_${folder})
      target_link_libraries(${target} PRIVATE waymark::${folder})
    endif()
  endforeach()
  target_link_libraries(${target} PRIVATE ${libraries})
  waymark_warnings(${target})
endfunction()

macro(waymark_check_arguments who)
  if(arg_UNPARSED_ARGUMENTS OR arg_KEYWORDS_MISSING_VALUES MATCHES "SOURCES|FILES")
    message(FATAL_ERROR "${who}: not understood: '${arg_UNPARSED_ARGUMENTS}'; SOURCES or FILES must name files")
  endif()
endmacro()

function(waymark_check_order name depends)
  set(folders ${WAYMARK_ENGINE} ${WAYMARK_MARKERS} ${WAYMARK_WORKBENCH} ${WAYMARK_WORKSHOP})
  if(NOT name IN_LIST folders)
    message(FATAL_ERROR "waymark_folder(${name}): add '${name}' to the folders in the top CMakeLists.txt")
  endif()
  foreach(dependency IN LISTS depends)
    if(NOT TARGET waymark_${dependency})
      message(FATAL_ERROR "waymark_folder(${name}): DEPENDS on '${dependency}', which is no folder before '${name}'. "
                          "A folder depends only on folders before it: ${folders}")
    endif()
  endforeach()
endfunction()

# Keeps the folders that <name> can include (itself and all that it depends on) as WAYMARK_REACH of its target.
function(waymark_record_reach name depends)
  set(reach ${name})
  foreach(dependency IN LISTS depends)
    get_target_property(further waymark_${dependency} WAYMARK_REACH)
    list(APPEND reach ${further})
  endforeach()
  list(REMOVE_DUPLICATES reach)
  set_target_properties(waymark_${name} PROPERTIES WAYMARK_REACH "${reach}")
endfunction()
