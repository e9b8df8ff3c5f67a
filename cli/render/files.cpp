// SPDX-License-Identifier: MIT
#include "cli/render/files.h"

#include "cli/render/text_table.h"

namespace gatewalk::cli {

void describe(Fields& out, const ExportResult& result) {
  out.count({"states", "1", "states of the chain"}, result.states);
  out.optional(result.transitions.has_value(), [&](Fields& f) {
    f.count({"transitions", "1", "entries of the matrix that are not zero"},
            result.transitions.value_or(0));
  });
  out.optional(result.first_ending.has_value(), [&](Fields& f) {
    f.count({"initial_state", "1", "number of the state in which walks start"}, 0);
    f.object({"endings", "by ending: the number of its state, which is never left"},
             [&](Fields& endings) {
               std::int64_t state = result.first_ending.value_or(0);
               for (const char* label : kEndingLabels)
                 endings.count({label, "1", "number of the state"}, state++);
             });
  });
  out.optional(result.trajectories.has_value(), [&](Fields& f) {
    f.count({"trajectories", "1", "trials, each as the states that it went through"},
            result.trajectories.value_or(0));
  });
  describe_made_by(out, result.made_by);
}

namespace {

void describe(Fields& out, const Sample& sample) {
  out.text({"name", "what `gatewalk sample NAME` calls it"}, sample.name);
  out.text({"file", "where it stands in the program's sources"}, sample.file);
  out.text({"about", "what it is"}, sample.about);
}

}  // namespace

void describe(Fields& out, const SampleResult& result) {
  out.either(
      !result.text,
      [&](Fields& f) {
        f.list({"samples", "all samples that there are"}, result.samples,
               [](Fields& item, const Sample& sample) { describe(item, sample); });
      },
      [&](Fields& f) {
        describe(f, result.samples.empty() ? Sample() : result.samples.front());
        f.text({"text", "the whole file"}, result.text.value_or(""));
      });
}

std::string table_of(const std::vector<Sample>& samples) {
  TextTable table({{"", -14, 0, "", "  "}, {}});
  for (const Sample& s : samples)
    // A name of 12 characters or more is two blanks away from what it is.
    table.row({s.name.size() > 12 ? s.name + "  " : s.name, s.about});
  return table.text();
}

}  // namespace gatewalk::cli
