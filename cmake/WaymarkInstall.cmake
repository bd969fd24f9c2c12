include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

# Where headers of each floor are installed. Those of the workbench have a directory of their own, so that who links the
# engine alone cannot include them.
set(WAYMARK_INSTALL_INCLUDE_waymark "${CMAKE_INSTALL_INCLUDEDIR}")
set(WAYMARK_INSTALL_INCLUDE_workbench "${CMAKE_INSTALL_INCLUDEDIR}/waymark-workbench")

# waymark_closure(<variable> <headers...>): these headers and all of ours that they include, as paths in the source tree.
function(waymark_closure variable)
  set(found "")
  set(pending ${ARGN})
  while(pending)
    list(POP_FRONT pending header)
    if(header IN_LIST found)
      continue()
    endif()
    list(APPEND found "${header}")
    set_property(DIRECTORY "${PROJECT_SOURCE_DIR}" APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/${header}")
    file(STRINGS "${PROJECT_SOURCE_DIR}/${header}" lines REGEX "^#include \"(waymark|workbench)/")
    foreach(line IN LISTS lines)
      string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" included "${line}")
      list(APPEND pending "${included}")
    endforeach()
  endwhile()
  set(${variable} "${found}" PARENT_SCOPE)
endfunction()

# waymark_component(<name> FOLDERS <folders...> DEPENDS <components...> HEADERS <public headers...>): waymark::<name> is these
# folders and components, or the one folder of that name; they are one export set. The public headers are installed with
# what they include, and no others.
function(waymark_component name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "FOLDERS;DEPENDS;HEADERS")
  list(TRANSFORM arg_FOLDERS PREPEND waymark_ OUTPUT_VARIABLE libraries)
  if(NOT TARGET waymark::${name})
    set(target waymark_component_${name})
    add_library(${target} INTERFACE)
    add_library(waymark::${name} ALIAS ${target})
    list(TRANSFORM arg_FOLDERS PREPEND waymark:: OUTPUT_VARIABLE links)
    list(TRANSFORM arg_DEPENDS PREPEND waymark:: OUTPUT_VARIABLE components)
    target_link_libraries(${target} INTERFACE ${links} ${components})
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
    list(APPEND libraries ${target})
  endif()
  install(TARGETS ${libraries} EXPORT waymark_${name})
  install(EXPORT waymark_${name} NAMESPACE waymark:: FILE waymark_${name}.cmake DESTINATION "${WAYMARK_PACKAGE_DIR}")
  waymark_closure(headers ${arg_HEADERS})
  foreach(header IN LISTS headers)
    string(REGEX MATCH "^[a-z]+" floor "${header}")
    get_filename_component(folder "${header}" DIRECTORY)
    install(FILES "${PROJECT_SOURCE_DIR}/${header}" DESTINATION "${WAYMARK_INSTALL_INCLUDE_${floor}}/${folder}")
  endforeach()
endfunction()

# waymark_install(): installs libraries and headers so that find_package(waymark COMPONENTS ...) works.
function(waymark_install)
  set(WAYMARK_PACKAGE_DIR "${CMAKE_INSTALL_LIBDIR}/cmake/waymark")
  waymark_component(engine FOLDERS ${WAYMARK_ENGINE} HEADERS waymark/waymark.hpp)
  waymark_component(markers FOLDERS ${WAYMARK_MARKERS} HEADERS waymark/markers/marker_front_end.hpp)
  if(WAYMARK_BUILD_WORKBENCH)
    waymark_component(
      workbench
      FOLDERS ${WAYMARK_WORKBENCH}
      DEPENDS engine markers
      HEADERS workbench/eval/evaluate.hpp
              workbench/logs/log_writer.hpp
              workbench/logs/map_files.hpp
              workbench/report/report.hpp
              workbench/report/results.hpp
              workbench/run/config.hpp
              workbench/run/make_filter.hpp
              workbench/run/open_source.hpp
              workbench/run/recording.hpp
              workbench/run/smoother.hpp)
  endif()

  set(config "${PROJECT_BINARY_DIR}/package/waymarkConfig.cmake")
  configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/waymarkConfig.cmake.in" "${config}"
                                INSTALL_DESTINATION "${WAYMARK_PACKAGE_DIR}")
  write_basic_package_version_file("${PROJECT_BINARY_DIR}/package/waymarkConfigVersion.cmake"
                                   COMPATIBILITY SameMinorVersion)
  install(FILES "${config}" "${PROJECT_BINARY_DIR}/package/waymarkConfigVersion.cmake"
          DESTINATION "${WAYMARK_PACKAGE_DIR}")
endfunction()
