// SPDX-License-Identifier: MIT
#include "cli/film/replay.h"

#include <gtest/gtest.h>

#include "cli/web/html.h"
#include "tests/cli/films.h"

namespace gatewalk::cli {
namespace {

int count(const std::string& text, const std::string& part) {
  int found = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != text.npos; at += part.size()) ++found;
  return found;
}

TEST(Html, EscapedTextIsOnlyText) {
  EXPECT_EQ(escaped("a<b & \"c\">"), "a&lt;b &amp; &quot;c&quot;&gt;");
}

TEST(Html, FilledLooksAtThePageOnce) {
  EXPECT_EQ(filled("1 {{a}} 2 {{b}}", {{"a", "{{b}}"}, {"b", "B"}}), "1 {{b}} 2 B");
  EXPECT_THROW((void)filled("{{c}}", {{"a", "A"}}), std::logic_error);
  EXPECT_THROW((void)filled("{{a", {{"a", "A"}}), std::logic_error);
}

/// The film in a page.
Json film_in(const std::string& page) {
  const std::string opening = "<script type=\"application/json\" id=\"film\">";
  const std::size_t begin = page.find(opening) + opening.size();
  return Json::parse(page.substr(begin, page.find("</script", begin) - begin));
}

TEST(Replay, PageHoldsTheFilm) {
  const std::string page = replay_page(small_film());
  EXPECT_EQ(film_in(page), json_of(small_film()));
  EXPECT_NE(page.find("<title>A small film</title>"), page.npos);
  EXPECT_NE(page.find("<p>trial 1: traversed left after 1 s</p>"), page.npos)
      << "said without scripts too";
  EXPECT_EQ(page.find("{{"), page.npos);
}

TEST(Replay, TextsCannotBreakOut) {
  Film film = small_film();
  film.title = film.runs[0].label = film.runs[0].ending =
      "</script><script>alert(1)</script><!-- {{film}}";
  const std::string page = replay_page(film);
  EXPECT_EQ(film_in(page), json_of(film));
  EXPECT_EQ(page.find("<script>alert"), page.npos);
  EXPECT_EQ(page.find("<!-- {{"), page.npos);
  EXPECT_EQ(count(page, "</script"), count(replay_page(small_film()), "</script"));
}

TEST(Replay, LoadsNothing) {
  const std::string page = replay_page(small_film());
  for (const char* address : {"http:", "https:", "src=", "@import", "url("})
    EXPECT_EQ(page.find(address), page.npos) << address;
  EXPECT_NE(page.find("default-src 'none'"), page.npos);
}

}  // namespace
}  // namespace gatewalk::cli
