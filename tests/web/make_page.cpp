// make_page REPORT.json PAGE.html: the page of a report, as `gatewalk reproduce` makes it.

#include <fstream>
#include <iostream>

#include "cli/paper/page.h"
#include "cli/render/json.h"
#include "cli/terminal/output.h"

int main(int argc, char** argv) try {
  if (argc != 3) throw std::invalid_argument("make_page REPORT.json PAGE.html");
  std::ifstream in(argv[1]);
  gatewalk::cli::write_text_atomically(argv[2],
                                       gatewalk::cli::report_page(gatewalk::cli::Json::parse(in)));
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
