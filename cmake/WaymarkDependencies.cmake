# Every package that the libraries need is found here, once, and repeated for users by waymarkConfig.cmake for the
# component that needs it.

set(WAYMARK_ENGINE_DEPENDENCIES "")
set(WAYMARK_WORKBENCH_DEPENDENCIES "")

# waymark_dependency(<ENGINE or WORKBENCH> <package> [find_package arguments...])
macro(waymark_dependency component)
  find_package(${ARGN} REQUIRED)
  string(REPLACE ";" " " waymark_dependency_line "find_dependency(${ARGN})")
  string(APPEND WAYMARK_${component}_DEPENDENCIES "${waymark_dependency_line}\n")
endmacro()

set(THREADS_PREFER_PTHREAD_FLAG ON)
waymark_dependency(ENGINE Threads)
waymark_dependency(ENGINE Eigen3 3.4 NO_MODULE)
waymark_dependency(ENGINE hwy CONFIG)
if(WAYMARK_BUILD_WORKBENCH)
  waymark_dependency(WORKBENCH fmt CONFIG)
  waymark_dependency(WORKBENCH yaml-cpp CONFIG)
  waymark_dependency(WORKBENCH nlohmann_json CONFIG)
  waymark_dependency(WORKBENCH ZLIB)
  waymark_dependency(WORKBENCH PNG)
  waymark_dependency(WORKBENCH JPEG)
  waymark_dependency(WORKBENCH BZip2)
  waymark_dependency(WORKBENCH SQLite3)
  # Linked by their names: Debian's libmatio-dev has neither a CMake package nor a .pc that works without HDF5's own, and
  # its liblz4-dev and libzstd-dev have no CMake package that other systems have, too; what finds NLopt may find the package
  # of its C++ interface instead; the package of libcivetweb-dev asks for a program that is not in it.
  foreach(library IN ITEMS matio lz4 zstd nlopt civetweb)
    find_library(WAYMARK_${library} ${library} REQUIRED)
    mark_as_advanced(WAYMARK_${library})
  endforeach()
endif()
