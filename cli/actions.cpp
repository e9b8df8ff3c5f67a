// SPDX-License-Identifier: MIT
#include "cli/actions.h"

#include <fmt/core.h>

#include <memory>
#include <stdexcept>
#include <utility>

#include "cli/arguments.h"
#include "cli/cells/program.h"
#include "cli/render/choice.h"
#include "lattice/scene/scene_problem.h"
#include "lattice/scene/terrain.h"

namespace gatewalk::cli {
namespace {

void require_two(std::size_t count, const std::string& source, const std::string& as_it_is) {
  if (count == 0)
    throw UsageError(
        fmt::format("{}: has no actions (tables [actions.NAME]). Give the scene, and the --set, of "
                    "the gatewalk "
                    "plan that made the policy",
                    source));
  if (count == 1)
    throw UsageError(fmt::format(
        "{}: has one action, and a policy chooses among two or more; an empty table [actions.NAME] "
        "is {}",
        source, as_it_is));
}

/// The program's cell with the parameters that a body has while it takes `action`.
std::shared_ptr<const dynamics::Cell> cell_with(const lattice::Terrain::Type& action,
                                                const ProgramCell& program) {
  std::unique_ptr<ProgramCell> cell = program.with({});
  for (const lattice::Terrain::Key& key : action.keys) try {
      cell = cell->with({{key.name.substr(lattice::kParameters.size()), key.value}});
    } catch (const std::invalid_argument& e) {
      throw UsageError(
          fmt::format("{}: actions.{}.{}: {}", key.origin, action.name, key.name, e.what()));
    }
  return cell;
}

Actions program_actions(const Options& options, const lattice::Source& s) {
  const lattice::CellFile& file = *s.cells;
  require_two(file.actions.size(), file.source, "the cell as it is");
  const auto* const program = dynamic_cast<const ProgramCell*>(s.problem.cells.cells.front().get());
  if (program == nullptr)
    throw UsageError("a cell is given: actions are numbers of a program, --cell-program");
  Actions all;
  std::string told;
  for (const lattice::Terrain::Type& action : file.actions) {
    all.actions.push_back({action.name, s.problem});
    const auto& cell = all.actions.back().problem.cells.cells.front() = cell_with(action, *program);
    const std::string words = action.name + ": " + text_of(*cell);
    options.depends_on(words);
    told += fmt::format("# {}\n", words);
  }
  all.methods.resize(all.actions.size());
  all.made_for = policy_field(file, told);
  return all;
}

}  // namespace

void require_file_for(const lattice::Source& s) {
  require_file_for(s.scene ? policy_field(*s.scene) : policy_field(*s.cells, ""));
}

std::vector<std::string> Actions::names() const {
  std::vector<std::string> names;
  for (const lattice::Action& action : actions) names.push_back(action.name);
  return names;
}

Actions actions_of(const Options& options, const lattice::Scene& scene,
                   const dynamics::Entry& start) {
  require_two(scene.actions.size(), scene.source, "the scene as it is");
  Actions all;
  for (const lattice::Terrain::Type& action : scene.actions) {
    lattice::Scene taken = lattice::with_action(scene, action);
    const auto from = lattice::RunsFrom::everywhere;
    const bool first = all.actions.empty();
    all.methods.push_back(
        first ? settle_method(options, taken, from)  // warns of keys without effect, once
              : lattice::settle_method(taken, from, options.seed(), options.work()));
    if (all.methods.back() && !first) options.warn(complaint(*all.methods.back()));
    all.actions.push_back({action.name, lattice::problem_with_all_types(taken)});
    all.actions.back().problem.start = start;
    all.scenes.push_back(std::move(taken));
  }
  all.made_for = policy_field(scene);
  return all;
}

Actions actions_of(const Options& options, const lattice::Source& s) {
  return s.scene ? actions_of(options, *s.scene, s.problem.start) : program_actions(options, s);
}

}  // namespace gatewalk::cli
