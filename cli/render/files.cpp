// SPDX-License-Identifier: MIT
#include "cli/render/files.h"

#include "cli/fields/text_table.h"

namespace gatewalk::cli {

void describe(Fields& out, const ExportResult& result) {
  out.count({"states", "1", "number of states of the exported chain"}, result.states);
  out.if_any({"transitions", "1", "number of transitions with a probability above zero"},
             result.transitions);
  out.optional(result.first_ending.has_value(), [&](Fields& f) {
    f.count({"initial_state", "1", "number of the state in which walks start; states count from 0"},
            0);
    f.object(
        {"endings", "number of the absorbing state of each ending; states count from 0"},
        [&](Fields& endings) {
          std::int64_t state = result.first_ending.value_or(0);
          for (const char* label : kEndingLabels)
            endings.count({label, "1", "number of the absorbing state of this ending"}, state++);
        });
  });
  out.if_any({"trajectories", "1",
              "number of trials that were written, each as the sequence of its states"},
             result.trajectories);
  describe_made_by(out, result.made_by);
}

namespace {

void describe(Fields& out, const Sample& sample) {
  out.text({"name", "name of the sample, for `gatewalk sample NAME`"}, sample.name);
  out.text({"file", "path of the sample in the program's sources"}, sample.file);
  out.text({"about", "what the sample shows"}, sample.about);
}

}  // namespace

void describe(Fields& out, const SampleResult& result) {
  out.either(
      !result.text,
      [&](Fields& f) {
        f.list({"samples", "all samples"}, result.samples,
               [](Fields& item, const Sample& sample) { describe(item, sample); });
      },
      [&](Fields& f) {
        describe(f, result.samples.empty() ? Sample() : result.samples.front());
        f.text({"text", "text of the whole sample file"}, result.text.value_or(""));
      });
}

std::string table_of(const std::vector<Sample>& samples) {
  TextTable table({{"", -12, 0, "", "  "}, {"", 0, 0, "", "  "}});
  for (const Sample& s : samples) table.row({s.name, s.about});
  return table.text();
}

}  // namespace gatewalk::cli
