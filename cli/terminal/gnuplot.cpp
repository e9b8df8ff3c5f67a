// SPDX-License-Identifier: MIT
#include "cli/terminal/gnuplot.h"

#include <fmt/core.h>

#include <algorithm>
#include <boost/crc.hpp>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "cli/fields/text.h"
#include "cli/terminal/child.h"
#include "cli/terminal/output.h"

namespace gatewalk::cli {

std::string drawn(const std::string& script) {
  const File in = scratch_file();
  if (std::fwrite(script.data(), 1, script.size(), in.get()) != script.size() ||
      std::fflush(in.get()) != 0)
    throw std::runtime_error(std::string("gnuplot cannot be run: its script cannot be written: ") +
                             std::strerror(errno));
  std::rewind(in.get());
  // The script as a named file, so that gnuplot's messages have line numbers and any error ends it.
  Child gnuplot({"gnuplot", "/dev/stdin"}, ::fileno(in.get()),
                "gnuplot was not found; it draws the figures (Debian: gnuplot-nox)");
  return gnuplot.output();
}

namespace {

// Width in print: one column of a journal (3.5 inches) for a sheet, in proportion for other
// figures.
double printed_inches(const Figure& f) { return 3.5 * f.width / Sheet::kWidth; }

enum class Kind { svg, pdf, png, other };
Kind kind_of(const std::string& path) {
  if (path.ends_with(".svg")) return Kind::svg;
  if (path.ends_with(".pdf")) return Kind::pdf;
  return path.ends_with(".png") ? Kind::png : Kind::other;
}

/// Font scale for gnuplot's cairo terminals that makes a point of the font one point of the
/// picture: Pango takes a point for 96/72 of a terminal's point.
constexpr double kPangoPoint = 0.75;

/// gnuplot's terminal for a figure, in the size that this kind of file has.
std::string terminal_of(Kind kind, const Figure& f) {
  const std::string look = fmt::format(" font 'sans,{}' background '#ffffff' enhanced", f.font);
  if (kind == Kind::svg) return fmt::format("svg size {},{}{}", f.width, f.height, look);
  if (kind == Kind::pdf) {
    const double shrunk = printed_inches(f) / f.width;
    return fmt::format("pdfcairo size {},{}{} fontscale {} linewidth {}", digits(printed_inches(f)),
                       digits(shrunk * f.height), look, digits(kPangoPoint * 72.0 * shrunk),
                       digits(72.0 * shrunk));
  }
  const double grown = 300.0 * printed_inches(f) / f.width;
  const std::string scale = digits(grown);
  return fmt::format("pngcairo size {},{}{} fontscale {} linewidth {} pointscale {}",
                     std::lround(grown * f.width), std::lround(grown * f.height), look,
                     digits(kPangoPoint * grown), scale, scale);
}

/// The text escaped for XML.
std::string in_xml(const std::string& text) {
  std::string out;
  for (const char c : text)
    if (c == '<')
      out += "&lt;";
    else if (c == '&')
      out += "&amp;";
    else
      out += c;
  return out;
}

/// Replaces the text between `begin` and `end`; changes nothing where these are not found.
void replace_between(std::string& text, const std::string& begin, const std::string& end,
                     const std::string& inside) {
  const std::size_t first = text.find(begin);
  if (first == std::string::npos) return;
  const std::size_t from = first + begin.size(), to = text.find(end, from);
  if (to != std::string::npos) text.replace(from, to - from, inside);
}

/// A style for SVG that follows the reader's light or dark mode. It colours the background and what
/// gnuplot draws in its default colour (`black`).
constexpr char kLightOrDark[] = R"(
<style>
svg { color-scheme: light dark }
[fill="#ffffff"] { fill: light-dark(#ffffff, #1b1f25) }
[fill="black"] { fill: light-dark(black, #e6e8eb) }
[stroke="black"] { stroke: light-dark(black, #e6e8eb) }
[color="black"] { color: light-dark(black, #e6e8eb) }
[color="gray"] { color: light-dark(gray, #5a636e) }
[stroke="gray"] { stroke: light-dark(gray, #5a636e) }
</style>)";

std::string svg_with(std::string svg, const AboutFigure& about) {
  replace_between(svg, "<title>", "</title>", in_xml(about.title));
  replace_between(svg, "<desc>", "</desc>", in_xml(about.made_by));
  const std::string before = "</desc>";
  if (const std::size_t at = svg.find(before); at != std::string::npos)
    svg.insert(at + before.size(), kLightOrDark);
  return svg;
}

/// A text string of PDF: ASCII characters, or UTF-8 with a byte order mark (ISO 32000-2).
std::string in_pdf(const std::string& text) {
  const bool ascii = std::none_of(text.begin(), text.end(), [](char c) { return (c & 0x80) != 0; });
  std::string out = ascii ? "(" : "(\xEF\xBB\xBF";
  for (const char c : text) {
    if (c == '(' || c == ')' || c == '\\') out += '\\';
    out += c;
  }
  return out + ")";
}

/// The number after the last `key` in the file.
long number_after(const std::string& pdf, const std::string& key) {
  const std::size_t at = pdf.rfind(key);
  if (at == std::string::npos) throw std::runtime_error("gnuplot wrote a PDF without " + key);
  return std::strtol(pdf.c_str() + at + key.size(), nullptr, 10);
}

/// The PDF with other document information, as an incremental update at its end (ISO 32000-1,
/// 7.5.6). Returns it unchanged if its cross-references are no plain table, as newer libraries may
/// write.
std::string pdf_with(std::string pdf, const AboutFigure& about) {
  if (pdf.find("\ntrailer") == std::string::npos) return pdf;
  const long size = number_after(pdf, "/Size"), root = number_after(pdf, "/Root"),
             info = number_after(pdf, "/Info"), previous = number_after(pdf, "startxref");
  const std::size_t object = pdf.size();
  pdf += fmt::format("{} 0 obj\n<< /Title {} /Subject {} /Creator (gatewalk) >>\nendobj\n", info,
                     in_pdf(about.title), in_pdf(about.made_by));
  const std::size_t table = pdf.size();
  return fmt::format(
      "{}xref\n{} 1\n{:010} 00000 n \n"
      "trailer\n<< /Size {} /Root {} 0 R /Info {} 0 R /Prev {} >>\n"
      "startxref\n{}\n%%EOF\n",
      pdf, info, object, size, root, info, previous, table);
}

/// The number as four bytes, the highest first.
std::string bytes(std::uint32_t n) {
  std::string out;
  for (const int shift : {24, 16, 8, 0}) out += static_cast<char>(n >> shift & 0xff);
  return out;
}

std::string png_chunk(const std::string& type_and_data) {
  boost::crc_32_type crc;
  crc.process_bytes(type_and_data.data(), type_and_data.size());
  return bytes(static_cast<std::uint32_t>(type_and_data.size() - 4)) + type_and_data +
         bytes(crc.checksum());
}

/// The PNG with texts and its resolution after the header (PNG specification, 11.3).
std::string png_with(std::string png, const AboutFigure& about) {
  constexpr std::size_t kHeader = 8 + 25;
  constexpr std::uint32_t kPerMetre = 11811;  // 300 dots per inch
  if (png.size() < kHeader) throw std::runtime_error("gnuplot wrote no PNG");
  const auto text = [](const std::string& key, const std::string& value) {
    return png_chunk("iTXt" + key + std::string(5, '\0') + value);
  };
  return png.insert(kHeader, png_chunk("pHYs" + bytes(kPerMetre) + bytes(kPerMetre) + '\1') +
                                 text("Title", about.title) + text("Description", about.made_by));
}

}  // namespace

void require_gnuplot() { (void)drawn("print 'gnuplot is there'"); }

bool can_be_drawn(const std::string& path) { return kind_of(path) != Kind::other; }

void draw(const std::string& path, const Figure& f, const AboutFigure& about) {
  const Kind kind = kind_of(path);
  if (kind == Kind::other)
    throw std::invalid_argument(path + ": the name of a figure ends in .svg, .pdf or .png");
  std::string made = drawn(fmt::format("set terminal {}\n{}\n", terminal_of(kind, f), f.commands));
  if (kind == Kind::svg) made = svg_with(std::move(made), about);
  if (kind == Kind::pdf) made = pdf_with(std::move(made), about);
  if (kind == Kind::png) made = png_with(std::move(made), about);
  write_text_atomically(path, made);
}

}  // namespace gatewalk::cli
