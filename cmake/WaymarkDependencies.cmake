# Every package that the libraries need is found here, once, and repeated for users by waymarkConfig.cmake.

set(WAYMARK_DEPENDENCIES "")

# waymark_dependency(<package> [find_package arguments...])
macro(waymark_dependency)
  find_package(${ARGV} REQUIRED)
  string(REPLACE ";" " " waymark_dependency_line "find_dependency(${ARGV})")
  string(APPEND WAYMARK_DEPENDENCIES "${waymark_dependency_line}\n")
endmacro()

set(THREADS_PREFER_PTHREAD_FLAG ON)
waymark_dependency(Threads)
waymark_dependency(Eigen3 3.4 NO_MODULE)
waymark_dependency(fmt CONFIG)
waymark_dependency(spdlog CONFIG)
waymark_dependency(yaml-cpp CONFIG)
waymark_dependency(nlohmann_json CONFIG)
waymark_dependency(hwy CONFIG)
waymark_dependency(ZLIB)
waymark_dependency(PNG)
waymark_dependency(JPEG)
# Debian's libmatio-dev has neither a CMake package nor a .pc that works without HDF5's own; it is linked by its name.
find_library(WAYMARK_MATIO matio REQUIRED)
mark_as_advanced(WAYMARK_MATIO)
