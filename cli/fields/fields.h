// SPDX-License-Identifier: MIT
#pragma once
/// A result described once, key by key: describe(Fields&, const Result&) names each key with its
/// unit and meaning and gives its value. Classes derived from Fields turn this description into the
/// result's JSON (json.h), a table of its numbers (csv.h) or the schema of all such results
/// (schema.h).

#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <ranges>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "cli/fields/json_fwd.h"
#include "markov/predict.h"
#include "markov/walk.h"

namespace gatewalk::cli {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();  // null in JSON
using Interval = std::array<double, 2>;  // limits of a 95 % interval; NaN: none
/// The interval; nullopt if its limits are NaN.
[[nodiscard]] inline std::optional<Interval> known(const Interval& limits) {
  return std::isfinite(limits[0]) ? std::optional(limits) : std::nullopt;
}

/// A key of a result, with what a reader of the result must know. Texts are not copied, so the
/// object must not outlive the call for which it is made.
struct ResultKey {
  std::string_view key, unit, meaning;
  std::string_view varies{};  // the key as shown if it differs among results: "mean_<cost>"
  std::optional<double> least{}, most{};  // bounds of numbers
  std::vector<std::string> words{};       // the texts allowed
  std::string_view shared_as{};           // name by which a schema defines the object or list once
  std::string_view interval{};            // meaning of KEY_95; empty: "95 % interval of KEY"
};

/// The key of a number, with its unit: "1" for shares, counts and ratios.
struct Field : ResultKey {
  Field(std::string_view name, std::string_view in, std::string_view what)
      : ResultKey{name, in, what} {}
  [[nodiscard]] Field varying(std::string_view shown) const {
    return with(&ResultKey::varies, shown);
  }
  /// Sets the meaning of KEY_95, if it is not simply the 95 % interval of the number.
  [[nodiscard]] Field bounded_by(std::string_view what) const {
    return with(&ResultKey::interval, what);
  }
  [[nodiscard]] Field at_least(double x) const { return with(&ResultKey::least, std::optional(x)); }
  [[nodiscard]] Field at_most(double x) const { return with(&ResultKey::most, std::optional(x)); }

 private:
  template <class T>
  [[nodiscard]] Field with(T ResultKey::*member, const T& value) const {
    Field changed = *this;
    changed.*member = value;
    return changed;
  }
};

/// The key of a flag, text, object or list, which has no unit.
struct Label : ResultKey {
  Label(std::string_view name, std::string_view what) : ResultKey{name, {}, what} {}
  [[nodiscard]] Label varying(std::string_view shown) const {
    Label changed = *this;
    changed.varies = shown;
    return changed;
  }
  /// Declares that the text is one of the `allowed` words.
  [[nodiscard]] Label one_of(std::vector<std::string> allowed) const {
    Label changed = *this;
    changed.words = std::move(allowed);
    return changed;
  }
  /// Sets the meaning of KEY_95, if it is not simply the 95 % intervals of the numbers.
  [[nodiscard]] Label bounded_by(std::string_view what) const {
    Label changed = *this;
    changed.interval = what;
    return changed;
  }
  /// Declares that the object or list stands in many places, so that a schema defines it once. Its
  /// name there is `name`, or the key if `name` is empty.
  [[nodiscard]] Label shared(std::string_view name = {}) const {
    Label changed = *this;
    changed.shared_as = name.empty() ? key : name;
    return changed;
  }
};

using TextRows = std::vector<std::vector<std::optional<std::string>>>;  // nullopt: null
using NumberRows = std::vector<std::vector<double>>;
using GateLimits = std::array<markov::CellProbabilities, 2>;  // 95 % limits: lower, upper

/// Several numbers for each gate, the same number of them for every gate. Gates stand one after the
/// other, row by row from the near row on.
struct GateNumbers {
  std::size_t rows, columns;
  std::vector<double> numbers;
};

/// The value of a field; std::monostate: null.
using Value =
    std::variant<std::monostate, double, std::int64_t, std::uint64_t, bool, std::string_view,
                 Interval, const std::vector<double>*, const std::vector<std::int64_t>*,
                 const std::vector<std::string>*, const TextRows*, const NumberRows*,
                 const std::vector<Interval>*, const Json*, const markov::CellProbabilities*,
                 const markov::CellCounts*, const GateLimits*, const GateNumbers*>;

/// The kind of value that a field has in all results.
enum class ValueKind {
  number,  // null if NaN or infinite
  count,   // an integer
  flag,
  text,
  interval,      // a 95 % interval, or null
  range,         // from and to
  numbers,       // a list of numbers or null
  counts,        // a list of integers
  number_rows,   // a list of lists of numbers or null
  texts,         // a list of texts
  text_rows,     // a list of lists of texts or null
  given,         // a number if the text is one, else the text
  givens,        // a list of such values
  intervals,     // a list of intervals
  points,        // a list of pairs of numbers
  grid,          // rows and columns of numbers, or null
  grid_95,       // rows and columns of intervals, or null
  gate_numbers,  // rows and columns of lists
};

class Fields;
using Description = std::function<void(Fields&)>;

class Fields {
 public:
  Fields() = default;
  virtual ~Fields() = default;
  Fields(const Fields&) = delete;
  Fields& operator=(const Fields&) = delete;

  void number(const Field& f, double x) { leaf(f, ValueKind::number, false, x); }
  template <std::integral T>
  void count(const Field& f, T n) {
    leaf(f, ValueKind::count, false, whole(n));
  }
  /// A count; nullopt: null.
  template <std::integral T>
  void count(const Field& f, const std::optional<T>& n) {
    leaf(f, ValueKind::count, true, n ? whole(*n) : Value());
  }
  void flag(const Label& l, bool yes) { leaf(l, ValueKind::flag, false, yes); }
  /// A flag; nullopt: null.
  template <std::same_as<std::optional<bool>> Yes>
  void flag(const Label& l, const Yes& yes) {
    leaf(l, ValueKind::flag, true, yes ? Value(*yes) : Value());
  }
  void text(const Label& l, std::string_view words) { leaf(l, ValueKind::text, false, words); }
  /// A text; nullopt: null.
  template <std::same_as<std::optional<std::string>> Words>
  void text(const Label& l, const Words& words) {
    leaf(l, ValueKind::text, true, words ? Value(std::string_view(*words)) : Value());
  }
  /// A 95 % interval whose number is not in the result; nullopt: null. For a number in the result,
  /// use estimate().
  void interval(const Field& f, const std::optional<Interval>& limits) {
    leaf(f, ValueKind::interval, true, value_of(limits));
  }
  /// A range from one number to another, which is no estimate.
  void range(const Field& f, const Interval& ends) { leaf(f, ValueKind::range, false, ends); }
  void numbers(const Field& f, const std::vector<double>& x) {
    leaf(f, ValueKind::numbers, false, &x);
  }
  /// A list of numbers; nullopt: null.
  template <std::same_as<std::optional<std::vector<double>>> Numbers>
  void numbers(const Field& f, const Numbers& x) {
    leaf(f, ValueKind::numbers, true, x ? Value(&*x) : Value());
  }
  /// A list of lists of numbers, which may differ in length.
  void number_rows(const Field& f, const NumberRows& rows) {
    leaf(f, ValueKind::number_rows, false, &rows);
  }
  void counts(const Field& f, const std::vector<std::int64_t>& n) {
    leaf(f, ValueKind::counts, false, &n);
  }
  void texts(const Label& l, const std::vector<std::string>& t) {
    leaf(l, ValueKind::texts, false, &t);
  }
  /// A list of texts; nullopt: null.
  template <std::same_as<std::optional<std::vector<std::string>>> Texts>
  void texts(const Label& l, const Texts& t) {
    leaf(l, ValueKind::texts, true, t ? Value(&*t) : Value());
  }
  /// A text for each gate, row by row from the near row on.
  void text_rows(const Label& l, const TextRows& rows) {
    leaf(l, ValueKind::text_rows, false, &rows);
  }
  /// A text that a user gave, written as a number if it is one.
  void given(const Field& f, std::string_view text) { leaf(f, ValueKind::given, false, text); }
  void givens(const Field& f, const std::vector<std::string>& t) {
    leaf(f, ValueKind::givens, false, &t);
  }
  void intervals(const Field& f, const std::vector<Interval>& bars) {
    leaf(f, ValueKind::intervals, false, &bars);
  }
  void points(const Field& f, const std::vector<std::array<double, 2>>& places) {
    leaf(f, ValueKind::points, false, &places);
  }
  /// A number for each gate, row by row from the near row on.
  void grid(const Field& f, const markov::CellProbabilities& x) {
    leaf(f, ValueKind::grid, true, &x);
  }
  void grid(const Field& f, const markov::CellCounts& n) { leaf(f, ValueKind::grid, true, &n); }
  void no_grid(const Field& f) { leaf(f, ValueKind::grid, true, {}); }
  /// A number for each gate, followed by their intervals as KEY_95; KEY_95 is null if no gate has
  /// one.
  void grid(const Field& f, const markov::CellProbabilities& x, const GateLimits& limits) {
    bounded(f, ValueKind::grid, &x, ValueKind::grid_95,
            limits[0].isFinite().any() ? Value(&limits) : Value());
  }
  void grid(const Field&, const markov::CellProbabilities&,
            GateLimits&&) = delete;  // the limits must outlive the call
  void no_estimated_grid(const Field& f) {
    bounded(f, ValueKind::grid, {}, ValueKind::grid_95, {});
  }
  void gate_numbers(const Field& f, const GateNumbers& n) {
    leaf(f, ValueKind::gate_numbers, false, &n);
  }
  /// Several numbers for each gate; nullopt: null.
  template <std::same_as<std::optional<GateNumbers>> Numbers>
  void gate_numbers(const Field& f, const Numbers& n) {
    leaf(f, ValueKind::gate_numbers, true, n ? Value(&*n) : Value());
  }
  /// A number, followed by its 95 % interval as KEY_95 in the same unit; nullopt: null.
  void estimate(const Field& f, double x, const std::optional<Interval>& limits) {
    bounded(f, ValueKind::number, x, ValueKind::interval, value_of(limits));
  }
  /// A count among `of`. KEY_95 is the 95 % interval of the share, times `of`; nullopt: null.
  template <std::integral T>
  void counted(const Field& f, T n, double of, const std::optional<Interval>& share) {
    bounded(f, ValueKind::count, whole(n), ValueKind::interval,
            share ? value_of(Interval{of * (*share)[0], of * (*share)[1]}) : Value());
  }
  /// An object whose numbers have their 95 % intervals in a second object after it, KEY_95.
  template <class Describe>
  void estimates(const Label& l, Describe describe) {
    enter(l, Shape::object, "");
    opened_.back() = LimitsOfObject{optional_, {}};
    describe(*this);
    put_limits(l, leave());
  }

  template <class Describe>
  void object(const Label& l, Describe describe) {
    enter(l, Shape::object, "");
    describe(*this);
    leave();
  }
  /// The object if there is one, else null. `describe` is given the object. A schema describes an
  /// object made by default if there is none and the type permits it.
  template <class Result, class Describe>
  void maybe(const Label& l, const Result& result, Describe describe) {
    if (!result && !is_schema()) return leaf(l, ValueKind::text, true, {});
    enter(l, Shape::object, "null");
    using Object = std::remove_cvref_t<decltype(*result)>;
    if (result)
      describe(*this, *result);
    else if constexpr (std::default_initializable<Object>)
      describe(*this, Object{});
    leave();
  }
  /// An object, or a text in its place.
  template <class Describe>
  void object_or_text(const Label& l, const std::optional<std::string>& words, Describe describe) {
    if (words && !is_schema()) return leaf(l, ValueKind::text, false, std::string_view(*words));
    enter(l, Shape::object, "string");
    describe(*this);
    leave();
  }
  /// A number (null if NaN or infinite), or an object in its place.
  template <class Describe>
  void number_or_object(const Field& f, const std::optional<double>& x, Describe describe) {
    if (x && !is_schema()) return leaf(f, ValueKind::number, false, *x);
    enter(f, Shape::object, "number");
    describe(*this);
    leave();
  }
  /// A list with an object for each item. A schema describes an item made by default if the list is
  /// empty and the type permits it.
  template <std::ranges::range Items, class Describe>
  void list(const Label& l, const Items& items, Describe describe) {
    list(l, &items, "", describe);
  }
  /// The list if there is one, else null.
  template <std::ranges::range Items, class Describe>
  void list(const Label& l, const std::optional<Items>& items, Describe describe) {
    if (!items && !is_schema()) return leaf(l, ValueKind::text, true, {});
    list(l, items ? &*items : nullptr, "null", describe);
  }
  /// A list with an object for each of the numbers 0 to n - 1.
  template <class Describe>
  void list_of(const Label& l, std::size_t n, Describe describe) {
    enter(l, Shape::list, "");
    for (std::size_t i = 0; i < n; ++i) {
      next();
      describe(*this, i);
    }
    leave();
  }
  /// An object that is already JSON, such as another result from a file; `describe` gives its
  /// schema.
  template <class Describe>
  void as_kept(const Label& l, const Json& json, Describe describe) {
    if (is_schema())
      object(l, describe);
    else
      leaf(l, ValueKind::text, false, &json);
  }
  /// Keys that not every result has: described if `there`, and always for a schema.
  template <class Describe>
  void optional(bool there, Describe describe) {
    if (!there && !is_schema()) return;
    begin_optional();
    ++optional_;
    describe(*this);
    --optional_;
    end_optional();
  }
  /// A key that stands only in results with a value for it.
  template <class Value>
  void if_any(const Field& f, const std::optional<Value>& x) {
    optional(x.has_value(), [&](Fields& out) {
      if constexpr (std::integral<Value>)
        out.count(f, x.value_or(0));
      else if constexpr (std::floating_point<Value>)
        out.number(f, x.value_or(kUnknown));
      else
        out.numbers(f, x.value_or(Value()));
    });
  }
  template <class Value, class Describe>
  void if_any(const Label& l, const std::optional<Value>& x, Describe describe) {
    optional(x.has_value(), [&](Fields& out) {
      if (x) return out.object(l, [&](Fields& f) { describe(f, *x); });
      if constexpr (std::default_initializable<Value>)
        out.object(l, [&](Fields& f) { describe(f, Value{}); });
    });
  }
  void if_any(const Label& l, const std::optional<std::string>& x) {
    optional(x.has_value(), [&](Fields& out) { out.text(l, x.value_or("")); });
  }
  /// One of two alternative sets of keys; a key may be in both.
  template <class First, class Second>
  void either(bool is_first, First first, Second second) {
    begin_either();
    if (is_first || is_schema()) first(*this);
    or_else();
    if (!is_first || is_schema()) second(*this);
    end_either();
  }
  /// Whether a schema is being made, so that every key that results may have must be described.
  [[nodiscard]] virtual bool is_schema() const { return false; }

 protected:
  enum class Shape { object, list };
  virtual void leaf(const ResultKey& key, ValueKind kind, bool may_be_null, const Value& value) = 0;
  /// `also`: what may stand in place of the object or list: "null", "string" or "number" (or null).
  virtual void open(const ResultKey& key, Shape shape, std::string_view also) = 0;
  /// A value, followed by its 95 % limits, which have the same shape.
  virtual void bounded(const Field& f, ValueKind kind, const Value& value, ValueKind limits_kind,
                       const Value& limits);
  virtual void next() = 0;  // the next item of a list
  virtual void close() = 0;
  virtual void begin_optional() {}
  virtual void end_optional() {}
  virtual void begin_either() {}
  virtual void or_else() {}
  virtual void end_either() {}

 private:
  template <class Items, class Describe>
  void list(const Label& l, const Items* items, std::string_view also, Describe describe) {
    enter(l, Shape::list, also);
    if (items)
      for (const auto& item : *items) {
        next();
        describe(*this, item);
      }
    if constexpr (std::default_initializable<std::ranges::range_value_t<Items>>)
      if (is_schema() && (!items || std::ranges::empty(*items))) {
        next();
        describe(*this, std::ranges::range_value_t<Items>{});
      }
    leave();
  }
  struct Limits {
    std::string key, unit, meaning, varies;
    bool is_optional;
    ValueKind kind;
    Value value;
  };
  struct LimitsOfObject {
    int optional;  // optional_ at the beginning of the object
    std::vector<Limits> all;
  };
  template <std::integral T>
  static Value whole(T n) {
    if constexpr (std::is_unsigned_v<T>)
      return static_cast<std::uint64_t>(n);
    else
      return static_cast<std::int64_t>(n);
  }
  static Value value_of(const std::optional<Interval>& limits) {
    return limits && known(*limits) ? Value(*limits) : Value();
  }
  void enter(const ResultKey& key, Shape shape, std::string_view also) {
    open(key, shape, also);
    opened_.emplace_back();
  }
  std::optional<LimitsOfObject> leave() {
    close();
    std::optional<LimitsOfObject> limits = std::move(opened_.back());
    opened_.pop_back();
    return limits;
  }
  void put_limits(const Label& l, const std::optional<LimitsOfObject>& limits);

  int optional_ = 0;  // > 0: not every result has the keys being described
  // Objects and lists not yet closed, innermost last, with the limits that are still to be written.
  std::vector<std::optional<LimitsOfObject>> opened_ =
      std::vector<std::optional<LimitsOfObject>>(1);
};

}  // namespace gatewalk::cli
