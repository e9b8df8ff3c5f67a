#include "cli/render/explicit_chain.h"

#include <array>
#include <bit>
#include <charconv>
#include <cstring>

#include "cli/render/json.h"

namespace gatewalk::cli {

using markov::ExplicitChain;

namespace {

/// Shortest digits that give the number back; of a sum that rounding puts above 1, 1.
std::string probability(double p) {
  std::array<char, 32> digits;
  return {digits.data(),
          std::to_chars(digits.data(), digits.data() + digits.size(), p < 1.0 ? p : 1.0).ptr};
}

/// A file in a POSIX tar (ustar), of no owner and no time.
void add_to_tar(std::string& tar, const std::string& name, const std::string& bytes) {
  std::array<char, 512> head{};
  const auto put = [&](std::size_t at, const std::string& text) {
    std::memcpy(head.data() + at, text.data(), text.size());
  };
  const auto octal = [](std::uint64_t number, std::size_t width) {
    std::string text(width, '0');
    for (std::size_t k = width; k-- > 0; number >>= 3)
      text[k] = static_cast<char>('0' + (number & 7));
    return text;
  };
  put(0, name);
  put(100, octal(0644, 7));
  put(108, octal(0, 7));
  put(116, octal(0, 7));
  put(124, octal(bytes.size(), 11));
  put(136, octal(0, 11));
  put(148, std::string(8, ' '));
  put(156, "0");
  put(257, std::string("ustar\0", 6) + "00");
  unsigned sum = 0;
  for (const char c : head) sum += static_cast<unsigned char>(c);
  put(148, octal(sum, 6) + std::string("\0 ", 2));
  tar.append(head.data(), head.size());
  tar += bytes;
  tar.append((512 - bytes.size() % 512) % 512, '\0');
}

template <class T>
std::string little_endian(const std::vector<T>& numbers) {
  static_assert(std::endian::native == std::endian::little && sizeof(T) == 8);
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T)};
}

/// One bit, of state `only`.
std::string one_bit(std::int64_t states, std::int64_t only) {
  std::string bits(static_cast<std::size_t>((states + 63) / 64 * 8), '\0');
  bits[static_cast<std::size_t>(only / 8)] = static_cast<char>(1 << (only % 8));
  return bits;
}

}  // namespace

const std::vector<std::string>& ending_labels() {
  static const std::vector<std::string> names{"trapped",   "crossed", "left_side",    "right_side",
                                              "went_back", "cut_off", "never_sampled"};
  return names;
}

std::string umb_of(const ExplicitChain& chain, const Json& tool) {
  const std::int64_t n = chain.size();
  const Json boolean = {{"type", "bool"}, {"size", 1}};
  Json aps = Json::object();
  for (const std::string& label : ending_labels())
    aps[label] = {{"alias", label}, {"applies-to", {"states"}}, {"type", boolean}};
  const Json index = {{"format-version", 1},
                      {"format-revision", 0},
                      {"model-data", {{"description", "a gatewalk field, as a Markov chain"}}},
                      {"file-data", tool},
                      {"transition-system",
                       {{"time", "discrete"},
                        {"#players", 0},
                        {"#states", n},
                        {"#initial-states", 1},
                        {"#choices", n},
                        {"#choice-actions", 0},
                        {"#branches", chain.target.size()},
                        {"#branch-actions", 0},
                        {"#observations", 0},
                        {"branch-probability-type", {{"type", "double"}, {"size", 64}}}}},
                      {"annotations", {{"aps", aps}}}};
  std::string tar;
  add_to_tar(tar, "index.json", text_of(index) + "\n");
  add_to_tar(tar, "state-is-initial.bin", one_bit(n, 0));
  add_to_tar(tar, "choice-to-branches.bin", little_endian(chain.first));
  add_to_tar(tar, "branch-to-target.bin", little_endian(chain.target));
  add_to_tar(tar, "branch-to-probability.bin", little_endian(chain.probability));
  for (std::size_t e = 0; e < ending_labels().size(); ++e)
    add_to_tar(tar, "annotations/aps/" + ending_labels()[e] + "/states/values.bin",
               one_bit(n, chain.ends() + static_cast<std::int64_t>(e)));
  return tar + std::string(1024, '\0');
}

std::string drn_of(const ExplicitChain& chain) {
  std::string text = "@type: DTMC\n@parameters\n\n@reward_models\n\n@nr_states\n" +
                     std::to_string(chain.size()) + "\n@nr_choices\n" +
                     std::to_string(chain.size()) + "\n@model\n";
  for (std::int64_t s = 0; s < chain.size(); ++s) {
    text += "state " + std::to_string(s);
    if (s == 0) text += " init";
    if (s >= chain.ends())
      text += " " + ending_labels()[static_cast<std::size_t>(s - chain.ends())];
    text += "\n\taction 0\n";
    for (auto k = static_cast<std::size_t>(chain.first[static_cast<std::size_t>(s)]);
         k < static_cast<std::size_t>(chain.first[static_cast<std::size_t>(s) + 1]); ++k)
      text += "\t\t" + std::to_string(chain.target[k]) + " : " + probability(chain.probability[k]) +
              "\n";
  }
  return text;
}

PrismFiles prism_of(const ExplicitChain& chain) {
  PrismFiles files;
  files.transitions =
      std::to_string(chain.size()) + " " + std::to_string(chain.target.size()) + "\n";
  files.states = "(i_x,i_y,state,draws,ending)\n";
  files.labels = "0=\"init\" 1=\"deadlock\"";
  for (std::size_t e = 0; e < ending_labels().size(); ++e)
    files.labels += " " + std::to_string(e + 2) + "=\"" + ending_labels()[e] + "\"";
  files.labels += "\n0: 0\n";
  for (std::int64_t s = 0; s < chain.size(); ++s) {
    const bool is_end = s >= chain.ends();
    const auto at = [&](auto number) { return std::to_string(number) + ","; };
    if (is_end) {
      const std::int64_t e = s - chain.ends();
      files.states += std::to_string(s) + ":(-1,-1,-1,-1," + std::to_string(e) + ")\n";
      files.labels += std::to_string(s) + ": " + std::to_string(e + 2) + "\n";
    } else {
      const ExplicitChain::State& state = chain.states[static_cast<std::size_t>(s)];
      files.states += std::to_string(s) + ":(" + at(state.column) + at(state.row) +
                      at(state.input) + at(state.draws) + "-1)\n";
    }
    for (auto k = static_cast<std::size_t>(chain.first[static_cast<std::size_t>(s)]);
         k < static_cast<std::size_t>(chain.first[static_cast<std::size_t>(s) + 1]); ++k)
      files.transitions += std::to_string(s) + " " + std::to_string(chain.target[k]) + " " +
                           probability(chain.probability[k]) + "\n";
  }
  return files;
}

}  // namespace gatewalk::cli
