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
waymark_dependency(yaml-cpp CONFIG)
waymark_dependency(nlohmann_json CONFIG)
waymark_dependency(hwy CONFIG)
waymark_dependency(ZLIB)
waymark_dependency(PNG)
waymark_dependency(JPEG)
waymark_dependency(BZip2)
waymark_dependency(SQLite3)
# Linked by their names: Debian's libmatio-dev has neither a CMake package nor a .pc that works without HDF5's own, and
# its liblz4-dev and libzstd-dev have no CMake package that other systems have, too; what finds NLopt may find the package of
# its C++ interface instead.
foreach(library IN ITEMS matio lz4 zstd nlopt)
  find_library(WAYMARK_${library} ${library} REQUIRED)
  mark_as_advanced(WAYMARK_${library})
endforeach()
