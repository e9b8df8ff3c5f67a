// SPDX-License-Identifier: MIT
#include "cli/fields/csv.h"

#include <fmt/format.h>

#include <cmath>
#include <concepts>

#include "cli/fields/json.h"
#include "cli/fields/json_value.h"

namespace gatewalk::cli {

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

namespace {

template <class Number>
using Grid = Eigen::Array<Number, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::string shown(double x) { return std::isfinite(x) ? json_number(x) : ""; }
/// 1 for true, 0 for false.
template <std::integral T>
std::string shown(T n) {
  return fmt::format("{:d}", n);
}
std::string shown_limits(const Interval& limits) {
  return fmt::format("{},{}", shown(limits[0]), shown(limits[1]));
}
constexpr char kNoLimits[] = ",";

class NumberFields final : public Fields {
 public:
  [[nodiscard]] std::string text() && {
    std::string csv = "quantity,i,j,value,low_95,high_95\n";
    for (const Row& row : rows_) csv += fmt::format("{},{}\n", csv_text(row.quantity), row.cells);
    return csv;
  }

 protected:
  void leaf(const ResultKey& key, ValueKind kind, bool, const Value& value) override {
    const std::string name(key.key);
    if (kind == ValueKind::given) return add_given(name, "", std::get<std::string_view>(value));
    if (kind == ValueKind::givens) {
      const auto& texts = *std::get<const std::vector<std::string>*>(value);
      for (std::size_t i = 0; i < texts.size(); ++i) add_given(name, shown(i), texts[i]);
      return;
    }
    if (const auto* words = std::get_if<std::string_view>(&value);
        words && (name == "key" || name == "name") && !scopes_.empty())
      scopes_.back().called = *words;
    std::visit([&](const auto& x) { add(name, x); }, value);
  }
  void bounded(const Field& f, ValueKind, const Value& value, ValueKind,
               const Value& limits) override {
    const std::string name(f.key);
    if (const auto* const* grid = std::get_if<const markov::CellProbabilities*>(&value)) {
      const auto* const* ends = std::get_if<const GateLimits*>(&limits);
      return add_grid(name, **grid, [&](Eigen::Index r, Eigen::Index c) {
        return ends ? shown_limits({(**ends)[0](r, c), (**ends)[1](r, c)}) : std::string(kNoLimits);
      });
    }
    const auto* ends = std::get_if<Interval>(&limits);
    const std::string bar = ends ? shown_limits(*ends) : kNoLimits;
    std::visit(
        [&](const auto& x) {
          if constexpr (requires { shown(x); })
            put(name, "", "", shown(x), bar);
          else
            put(name, "", "", "", bar);
        },
        value);
  }
  void open(const ResultKey& key, Shape shape, std::string_view) override {
    scopes_.push_back({std::string(key.key), shape == Shape::list, rows_.size(), rows_.size()});
  }
  void next() override {
    end_item();
    ++scopes_.back().items;
  }
  void close() override {
    end_item();
    const Scope scope = std::move(scopes_.back());
    scopes_.pop_back();
    if (scopes_.empty() && scope.name == "made_by")
      rows_.resize(scope.first);
    else
      put_before(scope.first, scope.name);
  }

 private:
  struct Row {
    std::string quantity, cells{};  // the text "i,j,value,low_95,high_95"
  };
  struct Scope {  // an object, or a list with its current item
    std::string name;
    bool is_list;
    std::size_t first, first_of_item;  // indices into rows_
    std::size_t items = 0;
    std::string called{};  // the item's key or name
  };

  void put_before(std::size_t first, const std::string& name) {
    for (std::size_t r = first; r < rows_.size(); ++r)
      rows_[r].quantity = fmt::format("{}.{}", name, rows_[r].quantity);
  }
  void end_item() {
    Scope& scope = scopes_.back();
    if (!scope.is_list || scope.items == 0) return;
    put_before(scope.first_of_item, scope.called.empty() ? shown(scope.items - 1) : scope.called);
    scope.first_of_item = rows_.size();
    scope.called.clear();
  }

  void put(const std::string& name, const std::string& i, const std::string& j,
           const std::string& value, const std::string& limits = kNoLimits) {
    rows_.push_back({name, fmt::format("{},{},{},{}", i, j, value, limits)});
  }
  void add_given(const std::string& name, const std::string& i, std::string_view text) {
    if (const Json number = parsed_json(text); number.is_number())
      put(name, i, "", text_of(number));
  }
  template <class Rows, class Limits>
  void add_grid(const std::string& name, const Rows& grid, Limits limits) {
    for (Eigen::Index r = 0; r < grid.rows(); ++r)
      for (Eigen::Index c = 0; c < grid.cols(); ++c)
        put(name, shown(r), shown(c), shown(grid(r, c)), limits(r, c));
  }

  void add(const std::string& name, std::monostate) { put(name, "", "", ""); }
  template <class T>
  requires requires(T x) { shown(x); }
  void add(const std::string& name, T x) { put(name, "", "", shown(x)); }
  template <class T>
  requires requires(T x) { shown(x); }
  void add(const std::string& name, const std::vector<T>* list) {
    for (std::size_t i = 0; i < list->size(); ++i) put(name, shown(i), "", shown((*list)[i]));
  }
  /// A list of lists, or of pairs.
  template <class List>
  requires requires(List x) { shown(x[0]); }
  void add(const std::string& name, const std::vector<List>* rows) {
    for (std::size_t i = 0; i < rows->size(); ++i)
      for (std::size_t j = 0; j < (*rows)[i].size(); ++j)
        put(name, shown(i), shown(j), shown((*rows)[i][j]));
  }
  void add(const std::string& name, const Interval& ends) {
    for (std::size_t i = 0; i < ends.size(); ++i) put(name, shown(i), "", shown(ends[i]));
  }
  template <class Number>
  void add(const std::string& name, const Grid<Number>* grid) {
    add_grid(name, *grid, [](Eigen::Index, Eigen::Index) { return std::string(kNoLimits); });
  }
  void add(const std::string& name, const GateNumbers* all) {
    const std::size_t gates = all->rows * all->columns,
                      each = gates > 0 ? all->numbers.size() / gates : 0;
    for (std::size_t gate = 0; gate < gates; ++gate)
      for (std::size_t i = 0; i < each; ++i)
        put(fmt::format("{}.{}.{}", name, gate / all->columns, gate % all->columns), shown(i), "",
            shown(all->numbers[gate * each + i]));
  }
  // The table leaves words out.
  void add(const std::string&, std::string_view) {}
  void add(const std::string&, const std::vector<std::string>*) {}
  void add(const std::string&, const TextRows*) {}
  void add(const std::string&, const Json*) {}
  void add(const std::string&, const GateLimits*) {}  // written with the grid of the numbers

  std::vector<Row> rows_;
  std::vector<Scope> scopes_;
};

}  // namespace

std::string table_of_numbers(const Description& describe) {
  NumberFields fields;
  describe(fields);
  return std::move(fields).text();
}

}  // namespace gatewalk::cli
