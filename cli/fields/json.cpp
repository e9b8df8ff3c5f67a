// SPDX-License-Identifier: MIT
#include "cli/fields/json.h"

#include <locale.h>

#include <cmath>
#include <utility>

#include "cli/fields/json_value.h"

namespace gatewalk::cli {
namespace {

/// The number; null if JSON cannot represent it.
Json or_null(double x) { return std::isfinite(x) ? Json(x) : Json(); }

/// Sets the C locale for this thread during the object's life.
class PlainLocale {
 public:
  PlainLocale() : before_(::uselocale(plain())) {}
  ~PlainLocale() { ::uselocale(before_); }
  PlainLocale(const PlainLocale&) = delete;
  PlainLocale& operator=(const PlainLocale&) = delete;

 private:
  static locale_t plain() {
    static const locale_t c = ::newlocale(LC_ALL_MASK, "C", nullptr);
    return c;
  }
  locale_t before_;
};

/// Writes fields as JSON, with keys in the order in which they are described.
class JsonFields final : public Fields {
 public:
  [[nodiscard]] Json take() && { return std::move(result_); }

 protected:
  void leaf(const ResultKey& key, ValueKind kind, bool, const Value& value) override {
    if (kind == ValueKind::given)
      put(key, json_of_given(std::get<std::string_view>(value)));
    else if (kind == ValueKind::givens)
      for (Json& list = put(key, Json::array());
           const std::string& text : *std::get<const std::vector<std::string>*>(value))
        list.push_back(json_of_given(text));
    else
      put(key, std::visit([](const auto& x) { return json_of_value(x); }, value));
  }
  void open(const ResultKey& key, Shape shape, std::string_view) override {
    open_.push_back(&put(key, shape == Shape::list ? Json::array() : Json::object()));
  }
  void next() override {
    if (!open_.back()->is_array()) open_.pop_back();  // the previous item
    open_.back()->push_back(Json::object());
    open_.push_back(&open_.back()->back());
  }
  void close() override {
    const bool is_item = open_.size() > 1 && open_[open_.size() - 2]->is_array();
    open_.resize(open_.size() - (is_item ? 2 : 1));
  }

 private:
  static Json json_of_value(std::monostate) { return {}; }
  static Json json_of_value(const Json* kept) { return *kept; }
  static Json json_of_value(double x) { return or_null(x); }
  static Json json_of_value(std::string_view words) { return std::string(words); }
  static Json json_of_value(const Interval& limits) {
    return {or_null(limits[0]), or_null(limits[1])};
  }
  static Json json_of_value(const TextRows* rows) {
    Json all = Json::array();
    for (const auto& row : *rows) {
      Json& texts = all.emplace_back(Json::array());
      for (const auto& text : row) texts.push_back(text ? Json(*text) : Json());
    }
    return all;
  }
  static Json json_of_given(std::string_view text) {
    Json number = parsed_json(text);
    return number.is_number() ? number : Json(text);
  }
  template <class T>
  static Json json_of_value(const T& x) {
    return Json(x);
  }
  template <class T>
  static Json json_of_value(const std::vector<T>* list) {
    return Json(*list);
  }
  template <class Number>
  static Json json_of_value(
      const Eigen::Array<Number, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>* grid) {
    Json rows = Json::array();
    for (Eigen::Index r = 0; r < grid->rows(); ++r) {
      Json row = Json::array();
      for (Eigen::Index c = 0; c < grid->cols(); ++c) row.push_back((*grid)(r, c));
      rows.push_back(std::move(row));
    }
    return rows;
  }
  static Json json_of_value(const GateLimits* limits) {
    const auto& [low, high] = *limits;
    Json rows = Json::array();
    for (Eigen::Index r = 0; r < low.rows(); ++r) {
      Json row = Json::array();
      for (Eigen::Index c = 0; c < low.cols(); ++c)
        row.push_back(std::isfinite(low(r, c)) ? json_of_value(Interval{low(r, c), high(r, c)})
                                               : Json());
      rows.push_back(std::move(row));
    }
    return rows;
  }
  static Json json_of_value(const GateNumbers* all) {
    const std::size_t gates = all->rows * all->columns,
                      each = gates > 0 ? all->numbers.size() / gates : 0;
    auto from = all->numbers.begin();
    Json rows = Json::array();
    for (std::size_t r = 0; r < all->rows; ++r) {
      Json row = Json::array();
      for (std::size_t c = 0; c < all->columns; ++c, from += static_cast<std::ptrdiff_t>(each))
        row.push_back(std::vector(from, from + static_cast<std::ptrdiff_t>(each)));
      rows.push_back(std::move(row));
    }
    return rows;
  }

  Json& put(const ResultKey& key, Json value) {
    Json& object = open_.empty() ? result_ : *open_.back();
    return object[std::string(key.key)] = std::move(value);
  }

  Json result_ = Json::object();
  std::vector<Json*> open_;  // objects and lists not yet closed, innermost last
};

}  // namespace

Json parsed_json(std::string_view text) {
  const PlainLocale guard;  // nlohmann reads by strtod and takes the decimal point for one byte
  return Json::parse(text, nullptr, false);
}

Json json_of(const Description& describe) {
  JsonFields fields;
  describe(fields);
  return std::move(fields).take();
}

std::string text_of(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::string json_text(const Description& describe, int indent) {
  return text_of(json_of(describe), indent);
}

std::string json_number(double x) { return Json(x).dump(); }
std::string json_string(std::string_view text) { return text_of(Json(std::string(text))); }

void describe_version(Fields& out) {
  out.count(Field("format_version", "1",
                  "version of the format: it changes when a key goes or changes its meaning")
                .at_least(kFormatVersion)
                .at_most(kFormatVersion),
            kFormatVersion);
}

Description with_format_version(Description result) {
  return [result = std::move(result)](Fields& out) {
    describe_version(out);
    result(out);
  };
}

std::string result_json(const Description& result, int indent) {
  return json_text(with_format_version(result), indent) + "\n";
}

}  // namespace gatewalk::cli
