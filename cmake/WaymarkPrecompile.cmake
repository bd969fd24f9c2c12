# What nearly every source includes is compiled once per build: it takes a second of each file otherwise. A header that
# relies on it instead of its own includes is found by scripts/tidy.sh, which works without.

# waymark_precompiled_headers(<target> HEADERS <headers...> LIBRARIES <imported targets...>)
function(waymark_precompiled_headers target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "HEADERS;LIBRARIES")
  set(source "${CMAKE_CURRENT_BINARY_DIR}/${target}.cpp")
  file(CONFIGURE OUTPUT "${source}" CONTENT "")
  add_library(${target} OBJECT "${source}")
  target_link_libraries(${target} PRIVATE ${arg_LIBRARIES})
  waymark_warnings(${target})  # -Wpedantic decides about macros, and the users must agree about those
  target_precompile_headers(${target} PRIVATE ${arg_HEADERS})
endfunction()
