// SPDX-License-Identifier: MIT
#include "cli/fields/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <stdexcept>

#include "cli/fields/json.h"
#include "cli/fields/text.h"

namespace gatewalk::cli {
namespace {

/// A key of results, and what its value may be.
struct Node {
  std::string key, unit, meaning, varies, also;
  std::optional<double> least, most;
  std::vector<std::string> words;
  bool is_always_there = true, may_be_null = false;
  std::string shared{};  // name of the shared definition of its keys; empty: defined here
  enum class Form { leaf, object, list } form = Form::leaf;
  ValueKind kind = ValueKind::number;  // for leaves
  std::vector<std::unique_ptr<Node>> keys{};
  std::vector<std::string> either{};  // keys that results with the keys `either_or` lack
  std::vector<std::string> either_or{};
  // An object may be described several times. Keys that not every description has are optional.
  int described = 0;     // how often the keys inside were described
  int described_in = 0;  // the latest description of the enclosing object with this key

  Node* find(std::string_view name) {
    const auto found =
        std::find_if(keys.begin(), keys.end(), [&](const auto& node) { return node->key == name; });
    return found == keys.end() ? nullptr : found->get();
  }
};

using Shared = std::map<std::string, std::unique_ptr<Node>, std::less<>>;

class SchemaFields final : public Fields {
 public:
  [[nodiscard]] bool is_schema() const override { return true; }
  [[nodiscard]] Node& root() { return root_; }
  [[nodiscard]] const Shared& shared() const { return shared_; }

 protected:
  void leaf(const ResultKey& key, ValueKind kind, bool may_be_null, const Value&) override {
    Node& node = add(key);
    node.form = Node::Form::leaf;
    node.kind = kind;
    node.may_be_null = node.may_be_null || may_be_null;
  }
  void open(const ResultKey& key, Shape shape, std::string_view also) override {
    Node& node = add(key);
    node.form = shape == Shape::list ? Node::Form::list : Node::Form::object;
    node.also = also;
    Node* inside = &node;
    if (!key.shared_as.empty()) {
      node.shared = key.shared_as;
      auto& defined = shared_[node.shared];
      if (!defined) defined = std::make_unique<Node>();
      inside = defined.get();
      inside->form = node.form;
    }
    ++inside->described;
    scopes_.push_back({inside, 0, {}});
  }
  void next() override {}
  void close() override {
    const Node& closed = *scopes_.back().node;
    if (closed.keys.empty())
      throw std::logic_error("what stands in " + closed.key +
                             " is not described: the example of the result has none");
    for (const auto& key : closed.keys)
      if (key->described_in != closed.described) key->is_always_there = false;
    scopes_.pop_back();
  }
  void begin_optional() override { ++scopes_.back().optional; }
  void end_optional() override { --scopes_.back().optional; }
  void begin_either() override {
    begin_optional();
    scopes_.back().keys = &scopes_.back().node->either;
  }
  void or_else() override { scopes_.back().keys = &scopes_.back().node->either_or; }
  void end_either() override {
    scopes_.back().keys = nullptr;
    end_optional();
    for (const auto& key : scopes_.back().node->keys) keep_if_in_both(*key);
  }

 private:
  struct Scope {
    Node* node;
    int optional;                      // > 0: not every result has the keys that follow
    std::vector<std::string>* keys{};  // collects the keys of an alternative
  };

  /// Marks a key of both alternatives as one that is always there.
  void keep_if_in_both(Node& key) {
    Node& node = *scopes_.back().node;
    const auto has = [&](const std::vector<std::string>& keys) {
      return std::find(keys.begin(), keys.end(), key.key) != keys.end();
    };
    if (!has(node.either) || !has(node.either_or)) return;
    std::erase(node.either, key.key);
    std::erase(node.either_or, key.key);
    key.is_always_there = scopes_.back().optional == 0;
  }

  Node& add(const ResultKey& key) {
    if (key.meaning.empty())
      throw std::logic_error("the key " + std::string(key.key) + " says nothing of its meaning");
    Scope& scope = scopes_.back();
    const bool is_always_there =
        scope.optional == 0 && key.varies.empty() && scope.node->described <= 1;
    const std::string_view name = key.varies.empty() ? key.key : key.varies;
    if (scope.keys && scope.optional == 1) scope.keys->emplace_back(name);
    if (Node* known = scope.node->find(name)) {
      known->described_in = scope.node->described;
      return *known;
    }
    auto node = std::make_unique<Node>();
    node->key = name;
    node->described_in = scope.node->described;
    node->unit = key.unit;
    node->meaning = key.meaning;
    node->varies = key.varies;
    node->least = key.least;
    node->most = key.most;
    node->words = key.words;
    node->is_always_there = is_always_there;
    scope.node->keys.push_back(std::move(node));
    return *scope.node->keys.back();
  }

  Node root_;
  Shared shared_;
  std::vector<Scope> scopes_{{&root_, 0, {}}};
};

// ---- As JSON Schema ----

std::string list_of(const std::vector<std::string>& texts) {
  std::string list;
  for (const std::string& text : texts) list += (list.empty() ? "" : ", ") + json_string(text);
  return "[" + list + "]";
}

/// The name of a ValueKind and its text in the schema: the type, to which "null" is added if the
/// value may be null, and what follows the type. Without a type, `rest` is the whole text.
struct KindText {
  const char *words, *type, *rest;
};
constexpr KindText kKinds[] = {
    {"number", "", R"("type": ["number", "null"])"},
    {"count", "integer", ""},
    {"yes or no", "boolean", ""},
    {"text", "string", ""},
    {"interval", "", R"("$ref": "#/$defs/interval")"},
    {"range", "array", R"(, "items": {"type": ["number", "null"]}, "minItems": 2, "maxItems": 2)"},
    {"numbers", "array", R"(, "items": {"type": ["number", "null"]})"},
    {"counts", "array", R"(, "items": {"type": "integer"})"},
    {"rows of numbers", "array",
     R"(, "items": {"type": "array", "items": {"type": ["number", "null"]}})"},
    {"texts", "array", R"(, "items": {"type": "string"})"},
    {"rows of texts", "array",
     R"(, "items": {"type": "array", "items": {"type": ["string", "null"]}})"},
    {"number or text", "", R"("type": ["number", "string"])"},
    {"numbers or texts", "array", R"(, "items": {"type": ["number", "string"]})"},
    {"intervals", "array", R"(, "items": {"$ref": "#/$defs/interval"})"},
    {"points", "array",
     R"(, "items": {"type": "array", "items": {"type": ["number", "null"]}, "minItems": 2, "maxItems": 2})"},
    {"grid", "", R"("$ref": "#/$defs/grid")"},
    {"grid of intervals", "",
     R"("type": ["array", "null"], "items": {"type": "array", "items": {"$ref": "#/$defs/interval"}})"},
    {"grid of lists", "array",
     R"(, "items": {"type": "array", "items": {"type": "array", "items": {"type": ["number", "null"]}}})"},
};
static_assert(std::size(kKinds) == static_cast<std::size_t>(ValueKind::gate_numbers) + 1);
const KindText& text_of(ValueKind kind) { return kKinds[static_cast<std::size_t>(kind)]; }

/// The schema of a leaf: "type": "integer", "minimum": 0
std::string type_of(const Node& node) {
  const auto& [words, type, rest] = text_of(node.kind);
  std::string text = rest;
  if (*type != '\0')
    text = (node.may_be_null ? fmt::format(R"("type": ["{}", "null"])", type)
                             : fmt::format(R"("type": "{}")", type)) +
           rest;
  if (node.least && node.least == node.most) return "\"const\": " + digits(*node.least);
  if (node.least) text += ", \"minimum\": " + digits(*node.least);
  if (node.most) text += ", \"maximum\": " + digits(*node.most);
  if (!node.words.empty()) text += ", \"enum\": " + list_of(node.words);
  return text;
}

/// The key, or for "mean_<cost>" the regular expression "mean_.+".
std::string expression_of(const Node& node) {
  if (node.varies.empty()) return node.key;
  const std::size_t from = node.varies.find('<'), to = node.varies.find('>');
  return node.varies.substr(0, from) + ".+" + node.varies.substr(to + 1);
}
/// The regular expression of a key that varies. It excludes other keys of `object` that the
/// expression would also match, such as "mean_<cost>_95".
std::string pattern_of(const Node& node, const Node& object) {
  const std::size_t from = node.varies.find('<'), to = node.varies.find('>');
  const std::string before = node.varies.substr(0, from), behind = node.varies.substr(to + 1);
  std::string others;
  for (const auto& other : object.keys) {
    const std::string shown = other->varies.empty() ? other->key : other->varies;
    if ((other->form != node.form || other->kind != node.kind) &&
        shown.size() > before.size() + behind.size() && shown.starts_with(before) &&
        shown.ends_with(behind))
      others += (others.empty() ? "" : "|") + expression_of(*other) + "$";
  }
  return "^" + (others.empty() ? "" : "(?!" + others + ")") + expression_of(node) + "$";
}
/// Whether the key may be any text: "<cost>".
bool is_any(const Node& node) {
  return node.varies.starts_with('<') && node.varies.find('>') + 1 == node.varies.size();
}

std::string schema_text(const Node& node, const std::string& indent, bool says_what);

/// The schema of an object after its type: "properties": {...}, "required": [...], ...
std::string keys_text(const Node& node, const std::string& indent) {
  std::string fixed, patterns, others = "false";
  std::vector<std::string> required;
  for (const auto& key : node.keys) {
    const auto line = [&](const std::string& name) {
      return indent + "  " + json_string(name) + ": " + schema_text(*key, indent + "  ", true);
    };
    if (key->varies.empty())
      fixed += (fixed.empty() ? "" : ",\n") + line(key->key);
    else if (is_any(*key))
      others = schema_text(*key, indent + " ", true);
    else
      patterns += (patterns.empty() ? "" : ",\n") + line(pattern_of(*key, node));
    if (key->is_always_there) required.push_back(key->key);
  }
  std::string text;
  if (!fixed.empty()) text += indent + " \"properties\": {\n" + fixed + "\n" + indent + " },\n";
  if (!patterns.empty())
    text += indent + " \"patternProperties\": {\n" + patterns + "\n" + indent + " },\n";
  if (!required.empty()) text += indent + " \"required\": " + list_of(required) + ",\n";
  if (!node.either.empty() || !node.either_or.empty())
    text += indent + R"( "oneOf": [{"required": )" + list_of(node.either) + R"(}, {"required": )" +
            list_of(node.either_or) + "}],\n";
  return text + indent + " \"additionalProperties\": " + others + "\n";
}

std::string schema_text(const Node& node, const std::string& indent, bool says_what) {
  std::string about;
  if (says_what) {
    about = "\"description\": " + json_string(node.meaning) + ", ";
    if (!node.unit.empty()) about += "\"unit\": " + json_string(node.unit) + ", ";
  }
  if (node.form == Node::Form::leaf) return "{" + about + type_of(node) + "}";
  if (!node.shared.empty() && says_what) {
    const std::string ref = "\"$ref\": " + json_string("#/$defs/" + node.shared);
    return "{" + about +
           (node.also.empty() ? ref
                              : R"("anyOf": [{"type": ")" + node.also + "\"}, {" + ref + "}]") +
           "}";
  }
  if (node.form == Node::Form::object)
    return "{" + about +
           (node.also.empty()       ? std::string(R"("type": "object")")
            : node.also == "number" ? std::string(R"("type": ["object", "number", "null"])")
                                    : R"("type": ["object", ")" + node.also + "\"]") +
           ",\n" + keys_text(node, indent) + indent + "}";
  return "{" + about + "\"type\": " +
         (node.also.empty() ? std::string("\"array\"") : "[\"array\", \"" + node.also + "\"]") +
         ", \"items\": {\"type\": \"object\",\n" + keys_text(node, indent) + indent + "}}";
}

// ---- As lines ----

constexpr char kHowToRead[] =
    "[] stands for each item of a list. An interval is [from, to], 95 %, null where there is none; "
    "that of a count is the interval of its share, times the number of runs, trials or walks. A "
    "range is [from, to], what a coordinate covers. A grid has a list for each row of gates, from "
    "the start's side on, with a value for each column.";

std::string type_words(const Node& node) {
  const auto& [words, type, rest] = text_of(node.kind);
  if (!node.may_be_null || *type == '\0') return words;
  return (node.kind == ValueKind::flag ? "yes, no" : words) + std::string(" or null");
}

std::string constraints_of(const Node& node) {
  if (node.least && node.least == node.most) return " " + digits(*node.least);
  std::string text = node.words.empty() ? "" : fmt::format(": {}", fmt::join(node.words, ", "));
  if (node.least) text += ", at least " + digits(*node.least);
  if (node.most) text += ", at most " + digits(*node.most);
  return text;
}

std::string type_of_key(const Node& key) {
  if (key.form == Node::Form::leaf) return type_words(key) + constraints_of(key);
  const std::string also = key.also == "string" ? "text" : key.also;
  return fmt::format("{}{}{}", key.form == Node::Form::list ? "list" : "object",
                     also.empty() ? "" : " or " + also,
                     key.shared.empty() || key.shared == key.key ? "" : ": " + key.shared);
}

void add_lines(const Node& node, const std::string& before, std::vector<KeyLine>& lines) {
  for (const auto& key : node.keys) {
    const std::string path = before + key->key;
    lines.push_back({path, type_of_key(*key), key->unit, key->meaning, key->is_always_there});
    if (key->shared.empty())
      add_lines(*key, path + (key->form == Node::Form::list ? "[]." : "."), lines);
  }
}

/// The text in lines of at most `width` bytes, broken between words. All lines but the first begin
/// with `indent`.
std::string in_lines(const std::string& text, std::size_t width, const std::string& indent) {
  std::string lines, line;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    if (!line.empty() && line.size() + 1 + word.size() > width) {
      lines += line + "\n" + indent;
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
    at = end + 1;
  }
  return lines + line;
}

}  // namespace

std::string file_name_of(std::string_view command) {
  std::string name(command);
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

std::string schema_of(const ResultOf& of) {
  SchemaFields fields;
  describe_version(fields);
  of.result(fields);
  std::string text =
      "{\n \"$schema\": \"https://json-schema.org/draft/2020-12/schema\",\n \"$id\": \"" +
      file_name_of(of.command) + ".schema.json\",\n \"title\": \"gatewalk " + of.command +
      " --json\",\n \"type\": \"object\",\n" + keys_text(fields.root(), "");
  text.pop_back();
  text += ",\n \"$defs\": {\n";
  for (const auto& [key, node] : fields.shared())
    text += "  " + json_string(key) + ": " + schema_text(*node, "  ", false) + ",\n";
  return text +
         R"(  "interval": {"description": "from and to, 95 %; null: none", "anyOf": [{"type": "null"},
   {"type": "array", "minItems": 2, "maxItems": 2, "items": {"type": ["number", "null"]}}]},
  "grid": {"description": "rows of numbers; null: too many", "type": ["array", "null"],
   "items": {"type": "array", "items": {"type": ["number", "null"]}}}
 }
}
)";
}

std::vector<KeyList> keys_of(const ResultOf& of) {
  SchemaFields fields;
  describe_version(fields);
  of.result(fields);
  std::vector<KeyList> lists{{of.command, {}}};
  add_lines(fields.root(), "", lists.front().keys);
  for (const auto& [name, node] : fields.shared()) {
    lists.push_back({name, {}});
    add_lines(*node, "", lists.back().keys);
  }
  return lists;
}

std::string result_page(const ResultOf& of) {
  std::string page = in_lines(
      fmt::format("The result of gatewalk {}, as --json writes it. Keys with a * are not in every "
                  "result. {}",
                  of.command, kHowToRead),
      112, "");
  page += "\n";
  for (const KeyList& list : keys_of(of)) {
    page += list.name == of.command ? "\nRESULT\n" : fmt::format("\n{}\n", list.name);
    for (const KeyLine& key : list.keys) {
      const std::string unit = key.unit.empty() || key.unit == "1" ? "" : ", " + key.unit;
      const std::string line = fmt::format(
          "{}{} ({}{}): {}", key.path, key.is_always_there ? "" : "*", key.type, unit, key.meaning);
      page += "  " + in_lines(line, 112, "      ") + "\n";
    }
  }
  return page;
}

std::string results_in_markdown() {
  std::string page = in_lines(
      fmt::format(
          "Made by `gatewalk help --write`; the same of one command: `gatewalk help COMMAND "
          "--result`. Keys with a `*` are not in every result. {}",
          kHowToRead),
      120, "");
  page = "# Results: the keys of `--json`\n\n" + page + "\n";
  std::map<std::string, std::vector<KeyLine>, std::less<>> shared;
  const auto add = [&page](const KeyList& list) {
    page +=
        fmt::format("\n## {}\n\n| key | type | unit | meaning |\n|---|---|---|---|\n", list.name);
    for (const KeyLine& key : list.keys)
      page += fmt::format("| `{}`{} | {} | {} | {} |\n", key.path, key.is_always_there ? "" : " *",
                          key.type, key.unit, key.meaning);
  };
  for (const ResultOf& of : results()) {
    const std::vector<KeyList> lists = keys_of(of);
    add(lists.front());
    for (std::size_t i = 1; i < lists.size(); ++i) shared[lists[i].name] = lists[i].keys;
  }
  for (const auto& [name, keys] : shared) add({"`" + name + "` of several commands", keys});
  return page;
}

}  // namespace gatewalk::cli
