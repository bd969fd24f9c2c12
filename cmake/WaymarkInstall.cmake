include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

# waymark_install(): installs libraries and headers so that find_package(waymark) works.
function(waymark_install)
  get_property(folders GLOBAL PROPERTY WAYMARK_ADDED_FOLDERS)
  list(TRANSFORM folders PREPEND waymark_ OUTPUT_VARIABLE libraries)

  # The umbrella: waymark::waymark is all folders.
  add_library(waymark_all INTERFACE)
  add_library(waymark::waymark ALIAS waymark_all)
  list(TRANSFORM folders PREPEND waymark:: OUTPUT_VARIABLE aliases)
  target_link_libraries(waymark_all INTERFACE ${aliases})
  set_target_properties(waymark_all PROPERTIES EXPORT_NAME waymark)

  install(TARGETS ${libraries} waymark_all EXPORT waymarkTargets)
  foreach(folder IN LISTS folders)
    install(
      DIRECTORY "${PROJECT_SOURCE_DIR}/waymark/${folder}"
      DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/waymark"
      FILES_MATCHING PATTERN "*.hpp")
  endforeach()

  set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/waymark")
  set(config "${PROJECT_BINARY_DIR}/package/waymarkConfig.cmake")
  configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/waymarkConfig.cmake.in" "${config}"
                                INSTALL_DESTINATION "${package_dir}")
  write_basic_package_version_file("${PROJECT_BINARY_DIR}/package/waymarkConfigVersion.cmake"
                                   COMPATIBILITY SameMinorVersion)
  install(FILES "${config}" "${PROJECT_BINARY_DIR}/package/waymarkConfigVersion.cmake" DESTINATION "${package_dir}")
  install(EXPORT waymarkTargets NAMESPACE waymark:: DESTINATION "${package_dir}")
endfunction()
