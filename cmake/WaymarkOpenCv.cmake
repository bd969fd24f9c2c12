# OpenCV is something to compare with, never something that the libraries need: waymark_opencv_features exists where its
# headers and libraries are found. They are named one by one, because the package of all of OpenCV is large.
find_path(WAYMARK_OPENCV_INCLUDE opencv2/features2d.hpp PATH_SUFFIXES opencv4)
find_library(WAYMARK_OPENCV_CORE opencv_core)
find_library(WAYMARK_OPENCV_FEATURES opencv_features2d)
find_library(WAYMARK_OPENCV_IMGPROC opencv_imgproc)
mark_as_advanced(WAYMARK_OPENCV_INCLUDE WAYMARK_OPENCV_CORE WAYMARK_OPENCV_FEATURES WAYMARK_OPENCV_IMGPROC)
if(WAYMARK_OPENCV_INCLUDE AND WAYMARK_OPENCV_CORE AND WAYMARK_OPENCV_FEATURES AND WAYMARK_OPENCV_IMGPROC)
  add_library(waymark_opencv_features INTERFACE)
  target_include_directories(waymark_opencv_features SYSTEM INTERFACE "${WAYMARK_OPENCV_INCLUDE}")
  target_link_libraries(waymark_opencv_features INTERFACE "${WAYMARK_OPENCV_FEATURES}" "${WAYMARK_OPENCV_IMGPROC}"
                                                          "${WAYMARK_OPENCV_CORE}")
endif()
