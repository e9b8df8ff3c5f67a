// SPDX-License-Identifier: MIT
#include "cli/render/numbers.h"

#include <array>
#include <cmath>

#include "cli/render/csv.h"
#include "cli/render/json.h"

namespace gatewalk::cli {
namespace {

bool is_value(const Json& json) { return json.is_number() || json.is_boolean() || json.is_null(); }

/// The 95 % limits of the number that the result holds beside `bars`; none where it is no pair.
std::array<Json, 2> limits_in(const Json& bars) {
  const bool is_pair =
      bars.is_array() && bars.size() == 2 && is_value(bars[0]) && is_value(bars[1]);
  return is_pair ? std::array<Json, 2>{bars[0], bars[1]} : std::array<Json, 2>{};
}

class NumberTable {
 public:
  explicit NumberTable(const Json& result) {
    csv_ = "quantity,i,j,value,low_95,high_95\n";
    if (result.contains("walks") && result["walks"].is_number())
      walks_ = result["walks"].get<double>();
  }

  /// `bars`: what the result says of its limits, of the same form; or "low" and "high" of such.
  /// `total`: how many were counted, where shares have limits and the numbers are counts.
  void add(const std::string& name, const Json& json, const Json& bars, double total = kUnknown) {
    if (is_value(json)) return line(name, {}, {}, json, limits_in(bars), total);
    if (json.is_object()) return add_object(name, json, bars, total);
    if (!json.is_array()) return;
    for (std::size_t i = 0; i < json.size(); ++i) {
      const Json& x = json[i];
      if (is_value(x)) {
        line(name, std::to_string(i), {}, x, limits_at(bars, i), total);
      } else if (x.is_array()) {
        for (std::size_t j = 0; j < x.size(); ++j)
          if (is_value(x[j]))
            line(name, std::to_string(i), std::to_string(j), x[j], limits_at(bars, i, j), total);
          else
            add(name + "." + std::to_string(i) + "." + std::to_string(j), x[j], {}, total);
      } else {
        add(name + "." + name_of(x, i), x, {}, total);
      }
    }
  }

  [[nodiscard]] std::string text() && { return std::move(csv_); }

 private:
  static const Json& at(const Json& json, std::size_t i) {
    static const Json kNone;
    return json.is_array() && i < json.size() ? json[i] : kNone;
  }
  static std::array<Json, 2> limits_at(const Json& bars, std::size_t i) {
    if (bars.is_object() && bars.contains("low") && bars.contains("high"))
      return {at(bars["low"], i), at(bars["high"], i)};
    return limits_in(at(bars, i));
  }
  static std::array<Json, 2> limits_at(const Json& bars, std::size_t i, std::size_t j) {
    if (bars.is_object() && bars.contains("low") && bars.contains("high"))
      return {at(at(bars["low"], i), j), at(at(bars["high"], i), j)};
    return limits_in(at(at(bars, i), j));
  }

  /// Where the limits of `key` stand beside it; empty: nowhere.
  static std::string bars_of(const Json& object, const std::string& key) {
    if (object.contains(key + "_95")) return key + "_95";
    if ((key == "probability" || key == "share") && object.contains("interval_95"))
      return "interval_95";
    return "";
  }
  static bool is_bars(const Json& object, const std::string& key) {
    if (key == "intervals_95") return true;
    if (key == "interval_95") return object.contains("probability") || object.contains("share");
    return key.ends_with("_95") && object.contains(key.substr(0, key.size() - 3));
  }

  /// An element of a list by what the result calls it, else by its number.
  static std::string name_of(const Json& element, std::size_t i) {
    for (const char* key : {"key", "name"})
      if (element.is_object() && element.contains(key) && element[key].is_string())
        return element[key].get<std::string>();
    return std::to_string(i);
  }

  void add_object(const std::string& name, const Json& object, const Json& bars, double total) {
    for (const char* key : {"walks", "trials"})  // of both: but for what is called so, the trials
      if (object.contains(key) && object[key].is_number()) total = object[key].get<double>();
    for (const auto& [key, value] : object.items()) {
      if ((name.empty() && (key == "made_by" || key == "format_version")) || is_bars(object, key))
        continue;
      Json own;
      if (const std::string place = bars_of(object, key); !place.empty())
        own = object[place];
      else if (object.contains("intervals_95") && object["intervals_95"].contains(key))
        own = object["intervals_95"][key];
      else if (bars.is_object() && bars.contains(key))
        own = bars[key];
      add(name.empty() ? key : name + "." + key, value, own, key == "walks" ? walks_ : total);
    }
  }

  static std::string shown(const Json& value) {
    if (value.is_null() || (value.is_number_float() && !std::isfinite(value.get<double>())))
      return "";
    return value.is_boolean() ? (value.get<bool>() ? "1" : "0") : value.dump();
  }
  void line(const std::string& name, const std::string& i, const std::string& j, const Json& value,
            std::array<Json, 2> limits, double total) {
    // The limits of a count are those of its share.
    for (Json& limit : limits)
      if (value.is_number_integer() && limit.is_number_float())
        limit = std::isnan(total) ? Json() : Json(limit.get<double>() * total);
    csv_ += csv_text(name) + "," + i + "," + j + "," + shown(value) + "," + shown(limits[0]) + "," +
            shown(limits[1]) + "\n";
  }

  double walks_ = kUnknown;  // of the result
  std::string csv_;
};

}  // namespace

std::string table_of_numbers(const Json& result) {
  NumberTable table(result);
  table.add("", result, {});
  return std::move(table).text();
}

}  // namespace gatewalk::cli
