# cmake -DPAGE=report.html -DOUT=report_page.cpp -P embed_page.cmake: a page as a string in C++.
file(READ "${PAGE}" page)
file(WRITE "${OUT}" "#include \"waymark/report/report_page.hpp\"

namespace waymark {

std::string_view report_page() { return R\"page(${page})page\"; }

}  // namespace waymark
")
