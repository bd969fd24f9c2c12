include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

# Where headers of each floor are installed. Those of the workbench have a directory of their own, so that who links the
# engine alone cannot include them.
set(WAYMARK_INSTALL_INCLUDE_waymark "${CMAKE_INSTALL_INCLUDEDIR}")
set(WAYMARK_INSTALL_INCLUDE_workbench "${CMAKE_INSTALL_INCLUDEDIR}/waymark-workbench")

# waymark_component(<name> FOLDERS <folders...> DEPENDS <components...>): waymark::<name> is these folders and components, or
# the one folder of that name; they are one export set.
function(waymark_component name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "FOLDERS;DEPENDS")
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
  foreach(folder IN LISTS arg_FOLDERS)
    get_target_property(floor waymark_${folder} WAYMARK_FLOOR)
    install(
      DIRECTORY "${PROJECT_SOURCE_DIR}/${floor}/${folder}"
      DESTINATION "${WAYMARK_INSTALL_INCLUDE_${floor}}/${floor}"
      FILES_MATCHING PATTERN "*.hpp")
  endforeach()
endfunction()

# waymark_install(): installs libraries and headers so that find_package(waymark COMPONENTS ...) works.
function(waymark_install)
  set(WAYMARK_PACKAGE_DIR "${CMAKE_INSTALL_LIBDIR}/cmake/waymark")
  waymark_component(engine FOLDERS ${WAYMARK_ENGINE})
  waymark_component(markers FOLDERS ${WAYMARK_MARKERS})
  if(WAYMARK_BUILD_WORKBENCH)
    waymark_component(workbench FOLDERS ${WAYMARK_WORKBENCH} DEPENDS engine markers)
  endif()
  install(FILES "${PROJECT_SOURCE_DIR}/waymark/waymark.hpp" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/waymark")

  set(config "${PROJECT_BINARY_DIR}/package/waymarkConfig.cmake")
  configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/waymarkConfig.cmake.in" "${config}"
                                INSTALL_DESTINATION "${WAYMARK_PACKAGE_DIR}")
  write_basic_package_version_file("${PROJECT_BINARY_DIR}/package/waymarkConfigVersion.cmake"
                                   COMPATIBILITY SameMinorVersion)
  install(FILES "${config}" "${PROJECT_BINARY_DIR}/package/waymarkConfigVersion.cmake"
          DESTINATION "${WAYMARK_PACKAGE_DIR}")
endfunction()
