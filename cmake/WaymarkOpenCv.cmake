# OpenCV finds calibration boards and reads videos, in a module that is loaded at run time, and is something that tests and
# benchmarks compare with; libapriltag finds AprilTags. Everything else builds and runs without them. OpenCV's modules are
# named one by one, because its package names all of them.

# waymark_find_modules(<name> <header> <libraries...>): WAYMARK_<name>_LIBRARIES are paths and WAYMARK_<name>_INCLUDE is
# the folder of the header where all are there; otherwise WAYMARK_<name>_FOUND is false. Paths, unlike targets, need
# nothing of who links with the installed libraries.
function(waymark_find_modules name header)
  find_path(WAYMARK_${name}_INCLUDE "${header}" PATH_SUFFIXES opencv4)
  mark_as_advanced(WAYMARK_${name}_INCLUDE)
  set(found TRUE)
  set(paths "")
  foreach(library IN LISTS ARGN)
    string(TOUPPER "WAYMARK_LIB_${library}" path)
    find_library(${path} "${library}")
    mark_as_advanced(${path})
    list(APPEND paths "${${path}}")
  endforeach()
  if(NOT WAYMARK_${name}_INCLUDE OR paths MATCHES "NOTFOUND")
    set(found FALSE)
  endif()
  set(WAYMARK_${name}_FOUND ${found} PARENT_SCOPE)
  set(WAYMARK_${name}_LIBRARIES "${paths}" PARENT_SCOPE)
endfunction()

set(WAYMARK_APRILTAG_FOUND FALSE)
set(WAYMARK_BOARDS_FOUND FALSE)
if(WAYMARK_WITH_OPENCV)
  waymark_find_modules(BOARDS opencv2/aruco/charuco.hpp opencv_aruco opencv_calib3d opencv_imgproc opencv_videoio
                       opencv_core)
  if(NOT WAYMARK_BOARDS_FOUND)
    message(STATUS "OpenCV's aruco, calib3d, imgproc, videoio or core is missing: built without camera calibration "
                   "(scripts/setup.sh --opencv)")
  endif()
endif()
if(WAYMARK_WITH_APRILTAG)
  waymark_find_modules(APRILTAG apriltag/apriltag.h apriltag apriltag-utils)
  if(NOT WAYMARK_APRILTAG_FOUND)
    message(STATUS "libapriltag is missing: built without AprilTags")
  endif()
endif()

# Where they are there to compare with: waymark_opencv_features, its corner detector, and waymark_opencv_aruco, its markers.
if(WAYMARK_BUILD_TESTS OR WAYMARK_BUILD_BENCH)
  foreach(oracle IN ITEMS "features;opencv2/features2d.hpp;opencv_features2d" "aruco;opencv2/aruco.hpp;opencv_aruco")
    list(POP_FRONT oracle name header library)
    string(TOUPPER "OPENCV_${name}" found)
    waymark_find_modules(${found} ${header} ${library} opencv_imgproc opencv_core)
    if(WAYMARK_${found}_FOUND)
      add_library(waymark_opencv_${name} INTERFACE)
      target_include_directories(waymark_opencv_${name} SYSTEM INTERFACE "${WAYMARK_${found}_INCLUDE}")
      target_link_libraries(waymark_opencv_${name} INTERFACE ${WAYMARK_${found}_LIBRARIES})
    endif()
  endforeach()
endif()
