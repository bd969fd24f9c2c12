# cmake -DNAME=report -DPAGE=report.html -DOUT=report_page.cpp -P embed_page.cmake: a page as a string in C++.
file(READ "${PAGE}" page)
file(WRITE "${OUT}" "#include \"workbench/report/pages.hpp\"

namespace waymark {

std::string_view ${NAME}_page() { return R\"page(${page})page\"; }

}  // namespace waymark
")
