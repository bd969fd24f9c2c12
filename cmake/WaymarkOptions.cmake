# Build options and the compiler settings that hold for every target.

option(WAYMARK_WARNINGS_AS_ERRORS "Treat compiler warnings as errors" OFF)
option(WAYMARK_BUILD_TESTS "Build the tests" ${PROJECT_IS_TOP_LEVEL})
option(WAYMARK_BUILD_BENCH "Build the micro-benchmarks" OFF)
option(WAYMARK_BUILD_WORKBENCH "Build what reads, simulates, evaluates and shows, and the program; else the engine alone" ON)
option(WAYMARK_BUILD_WORKSHOP "Build waymark-figures, which prints the figures of docs/results.md" OFF)
if(WAYMARK_BUILD_TESTS)
  set(WAYMARK_BUILD_WORKSHOP ON)  # it is tested, too
endif()
option(WAYMARK_BUILD_EXAMPLES "Test that the examples build and run against the installed library" ON)
option(WAYMARK_WITH_OPENCV "Find boards and read videos in calibrate camera, by OpenCV where it is installed" ON)
option(WAYMARK_WITH_APRILTAG "Find AprilTags in images, by libapriltag where it is installed" ON)
option(WAYMARK_COVERAGE "Instrument for coverage" OFF)
set(WAYMARK_SANITIZE "" CACHE STRING "Sanitizers, for example \"address;undefined\" or \"thread\"")
set(WAYMARK_DATA_DIR "${PROJECT_SOURCE_DIR}/../shared/data" CACHE PATH
    "Recordings that tests look for; the environment variable of the same name wins at run time")

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
# Sources wait for those of other folders only where they include what is generated there.
set(CMAKE_OPTIMIZE_DEPENDENCIES ON)

# The libraries also go into modules that are loaded at run time.
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
# Nobody replaces single functions of a library that is loaded: they may be inlined.
add_compile_options(-fno-semantic-interposition)

# The compiler must not fuse a*b+c where the machine can: the same input gives the same bits everywhere.
add_compile_options(-ffp-contract=off)

# g++ keeps more garbage the more memory the machine has; this takes a tenth off its largest processes for hardly any time.
add_compile_options($<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-expand=50>)

if(WAYMARK_SANITIZE)
  list(JOIN WAYMARK_SANITIZE "," sanitizers)
  add_compile_options(-fsanitize=${sanitizers} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${sanitizers})
  # Checks of every pointer double what the compiler has to do with Eigen, and find little that the address sanitizer does
  # not: what they would stop at is a crash a step later. Folders that read foreign bytes keep those of alignment.
  if(WAYMARK_SANITIZE MATCHES address)
    add_compile_options(-fno-sanitize=null,object-size,vptr,alignment,nonnull-attribute,returns-nonnull-attribute
                        -fno-sanitize-address-use-after-scope)
  endif()
endif()
if(WAYMARK_COVERAGE)
  add_compile_options(--coverage -fprofile-update=atomic)
  add_link_options(--coverage)
endif()

find_program(WAYMARK_CCACHE ccache)
mark_as_advanced(WAYMARK_CCACHE)
if(WAYMARK_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # One cache for all checkouts: paths inside the tree count relative to the build.
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env "CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}" CCACHE_NOHASHDIR=1
                                  "${WAYMARK_CCACHE}")
endif()

# waymark_warnings(<target>): the warnings that all our own code is free of. A plain struct may be initialised by its first
# or its named members only; the others have defaults. g++ 12 sees overlapping copies in "literal" + std::string (GCC bug
# 105651), and uninitialised members of variants that are moved (GCC bug 80635). In a batch of files the constants of one
# are in the scope of the next, where a local one may have the same name.
function(waymark_warnings target)
  target_compile_options(
    ${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wno-missing-field-initializers -Wno-restrict
                      -Wno-maybe-uninitialized -Wshadow
                      "$<$<AND:$<BOOL:${CMAKE_UNITY_BUILD}>,$<CXX_COMPILER_ID:GNU>>:-Wno-shadow;-Wshadow=local>"
                      $<$<BOOL:${WAYMARK_WARNINGS_AS_ERRORS}>:-Werror>)
endfunction()
