#include "cli/render/matrix.h"

#include "cli/render/report.h"
#include "cli/render/start.h"

namespace gatewalk::cli {

std::string faults_recorded(const Json& status) {
  try {
    return complaint(health_from(status));
  } catch (const Json::exception&) {
    return "the record of numerical faults is missing or damaged.";
  }
}

MatrixAndScene read_matrix_and_scene(const std::string& matrix_path, const std::string& scene_path,
                                     const std::vector<std::string>& overrides) {
  lattice::SceneMatrix m = lattice::read_scene_matrix(matrix_path, scene_path, overrides);
  const auto text = m.file.text.find("status");
  Json status = text == m.file.text.end() ? Json() : Json::parse(text->second, nullptr, false);
  if (const std::string faults = faults_recorded(status); !faults.empty())
    warn("the runs that made " + matrix_path + ": " + faults);
  return {std::move(m.file), std::move(m.scene), std::move(status)};
}

lattice::ChainStart checked_start(const dynamics::StateSpace& space,
                                  const lattice::FieldParams& field,
                                  const dynamics::BodyState& body, const std::string& name) {
  const lattice::ChainStart start = lattice::start_in_bins(space, field, body, name);
  if (start.beyond)
    warn(name + " lies beyond every entry that the bins were made from, " +
         lattice::entry_bins(space) +
         "; the prediction is that of the outermost bin. A matrix of a scene with this start suits "
         "it");
  return start;
}

void require_inside_bins(const std::vector<lattice::PaperStart>& starts,
                         const lattice::Scene& scene, const dynamics::StateSpace& space) {
  for (const lattice::PaperStart& s : starts)
    (void)checked_start(space, scene.field, s.body(), "start" + start_text(s));
}

ReadyStart ready_start(const Options& options, const MatrixAndScene& m,
                       const dynamics::BodyState& body, const std::string& name) {
  const dynamics::StateSpace& space = m.file.transitions.space;
  const lattice::ChainStart start = checked_start(space, m.scene.field, body, name);
  const dynamics::Cell cell = space.cell(start.start.input);
  const std::string text = text_of(cell);
  const auto on_edge = [](const std::array<double, 2>& edges, double v) {
    return edges[0] < edges[1] && (v == edges[0] || v == edges[1]);
  };
  if (on_edge(cell.d, body.x) || on_edge(cell.vx, body.vx) || on_edge(cell.vy, body.vy))
    remark(options, name + " lies on an edge of its bin, " + text +
                        "; its prediction is that of the whole bin");
  return {start, text};
}

ReadyChain ready_chain(const Options& options, const MatrixAndScene& m) {
  const auto [start, text] = ready_start(options, m, m.scene.start, "the start");
  return {lattice::make_chain(m.file.transitions), start, text};
}

}  // namespace gatewalk::cli
