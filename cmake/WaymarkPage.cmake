# Pages are built in. They are bundled from web/ by scripts/pages.sh, which needs node; building does not.

# waymark_page(<name> <variable>): <variable> is a generated source with the page web/built/<name>.html, <name>_page() of
# workbench/report/pages.hpp.
function(waymark_page name variable)
  set(page "${PROJECT_SOURCE_DIR}/web/built/${name}.html")
  set(page_cpp "${CMAKE_CURRENT_BINARY_DIR}/${name}_page.cpp")
  set(script "${PROJECT_SOURCE_DIR}/workbench/report/embed_page.cmake")
  add_custom_command(
    OUTPUT "${page_cpp}"
    COMMAND "${CMAKE_COMMAND}" "-DNAME=${name}" "-DPAGE=${page}" "-DOUT=${page_cpp}" -P "${script}"
    DEPENDS "${page}" "${script}"
    COMMENT "Embedding the ${name} page"
    VERBATIM)
  set(${variable} "${page_cpp}" PARENT_SCOPE)
endfunction()
