// SPDX-License-Identifier: MIT
#include "cli/python/python_fields.h"

#include <pybind11/numpy.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "cli/fields/json_value.h"

namespace gatewalk::python {
namespace {

namespace py = pybind11;
using cli::ValueKind;

/// An array of this shape from numbers that stand row by row.
template <class Number>
py::object array_of(const Number* numbers, auto... shape) {
  py::array_t<double> all({static_cast<py::ssize_t>(shape)...});
  if (all.size() == 0) return py::list();
  std::copy_n(numbers, all.size(), all.mutable_data());
  return all;
}

py::object python_of(std::monostate) { return py::none(); }
py::object python_of(double x) {
  if (!std::isfinite(x)) return py::none();
  return py::float_(x);
}
py::object python_of(bool yes) { return py::bool_(yes); }
py::object python_of(std::integral auto n) { return py::int_(n); }
py::object python_of(std::string_view words) { return py::str(words); }
py::object python_of(const cli::Interval& ends) { return array_of(ends.data(), ends.size()); }
py::object python_of(const cli::Json* json) {
  return py::module_::import("json").attr("loads")(cli::text_of(*json));
}
py::object python_of(const std::vector<std::string>* texts) {
  py::list all;
  for (const std::string& text : *texts) all.append(text);
  return all;
}
py::object python_of(const cli::TextRows* rows) {
  py::list all;
  for (const auto& row : *rows) {
    py::list texts;
    for (const auto& text : row) texts.append(text ? python_of(*text) : py::none());
    all.append(texts);
  }
  return all;
}
template <class Number>
requires std::is_arithmetic_v<Number> py::object python_of(const std::vector<Number>* list) {
  return array_of(list->data(), list->size());
}
/// Rows of different lengths become a list of arrays.
template <class Row>
requires std::same_as<typename Row::value_type, double> py::object python_of(
    const std::vector<Row>* rows) {
  std::vector<double> numbers;
  py::list list;
  for (const Row& row : *rows) {
    numbers.insert(numbers.end(), row.begin(), row.end());
    list.append(array_of(row.data(), row.size()));
  }
  const bool is_table = std::ranges::all_of(
      *rows, [&](const Row& row) { return !row.empty() && row.size() == rows->front().size(); });
  if (!is_table || rows->empty()) return list;
  return array_of(numbers.data(), rows->size(), rows->front().size());
}
template <class Number>
py::object python_of(
    const Eigen::Array<Number, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>* grid) {
  return array_of(grid->data(), grid->rows(), grid->cols());
}
py::object python_of(const cli::GateLimits* limits) {
  const auto& [low, high] = *limits;
  std::vector<double> ends;
  for (Eigen::Index i = 0; i < low.size(); ++i)
    ends.insert(ends.end(), {low.data()[i], high.data()[i]});
  return array_of(ends.data(), low.rows(), low.cols(), 2);
}
py::object python_of(const cli::GateNumbers* all) {
  const std::size_t gates = all->rows * all->columns;
  return array_of(all->numbers.data(), all->rows, all->columns,
                  gates > 0 ? all->numbers.size() / gates : 0);
}

py::object of_given(std::string_view text) {
  const cli::Json number = cli::parsed_json(text);
  return number.is_number() ? python_of(&number) : python_of(text);
}
/// An array if all texts are numbers, else a list.
py::object of_givens(const std::vector<std::string>& texts) {
  py::list all;
  bool are_numbers = !texts.empty();
  for (const std::string& text : texts) {
    const py::object one = of_given(text);
    are_numbers = are_numbers && !py::isinstance<py::str>(one);
    all.append(one);
  }
  if (!are_numbers) return all;
  return py::array_t<double>(all);
}

class PythonFields final : public cli::Fields {
 public:
  [[nodiscard]] py::dict take() && { return std::move(open_.front().object); }

 protected:
  void leaf(const cli::ResultKey& key, ValueKind kind, bool, const cli::Value& value) override {
    if (kind == ValueKind::given)
      put(key, of_given(std::get<std::string_view>(value)));
    else if (kind == ValueKind::givens)
      put(key, of_givens(*std::get<const std::vector<std::string>*>(value)));
    else if (const auto* ends = std::get_if<cli::Interval>(&value);
             ends && kind != ValueKind::range)
      put(key, py::make_tuple((*ends)[0], (*ends)[1]));
    else
      put(key, std::visit([](const auto& x) { return python_of(x); }, value));
  }
  void open(const cli::ResultKey& key, Shape shape, std::string_view) override {
    Scope scope;
    put(key, shape == Shape::list ? py::object(scope.items) : scope.object);
    open_.push_back(std::move(scope));
  }
  void next() override {
    Scope& list = open_.back();
    list.object = py::dict();
    list.items.append(list.object);
  }
  void close() override { open_.pop_back(); }

 private:
  struct Scope {  // an object, or a list with its current item
    py::list items{};
    py::dict object{};
  };
  void put(const cli::ResultKey& key, const py::object& value) {
    open_.back().object[py::str(key.key)] = value;
  }

  std::vector<Scope> open_ = std::vector<Scope>(1);  // innermost last
};

}  // namespace

py::dict to_python(const cli::Description& describe) {
  PythonFields fields;
  describe(fields);
  return std::move(fields).take();
}

}  // namespace gatewalk::python
