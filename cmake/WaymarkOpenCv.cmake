# OpenCV finds ArUco markers and calibration boards, reads videos, and is something that tests compare with; libapriltag
# finds AprilTags. Everything else builds and runs without them. OpenCV's modules are named one by one, because its
# package names all of them.

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

set(WAYMARK_ARUCO_FOUND FALSE)
set(WAYMARK_APRILTAG_FOUND FALSE)
set(WAYMARK_BOARDS_FOUND FALSE)
set(WAYMARK_BOARDS_LIBRARIES "")
if(WAYMARK_WITH_OPENCV)
  waymark_find_modules(ARUCO opencv2/aruco.hpp opencv_aruco opencv_calib3d opencv_imgproc opencv_core)
  if(NOT WAYMARK_ARUCO_FOUND)
    message(STATUS "OpenCV's aruco, calib3d, imgproc or core is missing: built without ArUco markers")
  endif()
  waymark_find_modules(BOARDS opencv2/aruco/charuco.hpp opencv_aruco opencv_calib3d opencv_imgproc opencv_videoio
                       opencv_core)
  if(NOT WAYMARK_BOARDS_FOUND)
    set(WAYMARK_BOARDS_LIBRARIES "")
    message(STATUS "OpenCV's aruco, calib3d, imgproc, videoio or core is missing: built without camera calibration")
  endif()
endif()
if(WAYMARK_WITH_APRILTAG)
  waymark_find_modules(APRILTAG apriltag/apriltag.h apriltag apriltag-utils)
  if(NOT WAYMARK_APRILTAG_FOUND)
    message(STATUS "libapriltag is missing: built without AprilTags")
  endif()
endif()

# waymark_opencv_features exists where OpenCV's corner detector is there to compare with.
if(WAYMARK_BUILD_TESTS OR WAYMARK_BUILD_BENCH)
  waymark_find_modules(OPENCV_FEATURES opencv2/features2d.hpp opencv_features2d opencv_imgproc opencv_core)
  if(WAYMARK_OPENCV_FEATURES_FOUND)
    add_library(waymark_opencv_features INTERFACE)
    target_include_directories(waymark_opencv_features SYSTEM INTERFACE "${WAYMARK_OPENCV_FEATURES_INCLUDE}")
    target_link_libraries(waymark_opencv_features INTERFACE ${WAYMARK_OPENCV_FEATURES_LIBRARIES})
  endif()
endif()
