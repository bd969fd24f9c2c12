# Stands for a folder whose CMakeLists.txt names a folder after it; must stop with the reason.
cmake_minimum_required(VERSION 3.22)
include("${CMAKE_CURRENT_LIST_DIR}/../../cmake/WaymarkFolder.cmake")
set(WAYMARK_ENGINE core slam)
waymark_check_order(core slam)
