// SPDX-License-Identifier: MIT
#include "lattice/source/cell_matrix.h"

#include <utility>

#include "lattice/pool/remembered.h"
#include "lattice/pool/tree_chain.h"
#include "lattice/scene/matrix.h"

namespace gatewalk::lattice {
namespace {

CellFile cells_in(const std::map<std::string, std::string>& text, const std::string& path,
                  const std::vector<std::string>& overrides) {
  CellFile cells = parse_cell_file(text.at(kCellText), path + " (its cells)", overrides);
  if (const auto words = text.find(markov::kWordsText); words != text.end())
    cells.map = with_words(cells.map, words_in(words->second, cells.map));
  return cells;
}

}  // namespace

CellMatrix cell_matrix(std::shared_ptr<const MatrixFile> file, const std::string& path,
                       const std::vector<std::string>& overrides) {
  for (const std::string& set : overrides)
    if (!set.starts_with("field.") && !set.starts_with("terrain.") && !set.starts_with("start."))
      throw SceneError("--set " + set + ": " + path +
                       " has its runs, and only keys of field, terrain and start can be set");
  CellMatrix m{std::move(file), {}, {}, {}};
  m.cells = cells_in(m.file->text, path, overrides);
  m.problem = problem_of(m.cells, {});
  if (!has_runs(*m.file)) return m;
  m.pool = pool_of(*m.file, m.problem, path);
  m.problem = problem_of(m.cells, *m.pool);
  return m;
}

std::vector<dynamics::Transitions> matrices_of(const MatrixFile& file, const CellFile& cells) {
  std::vector<dynamics::Transitions> matrices{file.transitions};
  for (std::size_t type = 1; type < cells.types.size(); ++type)
    matrices.push_back(file.types.at(cells.types[type]));
  return matrices;
}

std::vector<dynamics::Transitions> cell_matrices(const Problem& problem, const RunPool& pool,
                                                 int per_leaf) {
  return transitions_of(kernel_of(problem.map(), pool, per_leaf), problem.map(), problem.field, {},
                        {});
}

MatrixFile cell_matrix_file(std::vector<dynamics::Transitions> matrices, CellFile cells,
                            const RunPool& pool, std::map<std::string, std::string> text) {
  cells.has_scale.assign(cells.has_scale.size(), true);
  text[kCellText] = to_toml(cells);
  if (const std::string comment = comment_on_counts(cells.map, matrices.front().space);
      !comment.empty())
    text[kCommentText] = comment;
  if (cells.map.section.words) text[markov::kWordsText] = text_of(*cells.map.section.words);
  MatrixFile file{std::move(matrices.front()), std::move(text), arrays_of(pool, cells.map.section)};
  for (std::size_t type = 1; type < matrices.size(); ++type)
    file.types.emplace(cells.types[type], std::move(matrices[type]));
  return file;
}

MatrixFile read_matrix(const std::string& path) {
  return read_matrix(path, [&](const std::map<std::string, std::string>& text) {
    return text.contains(kCellText) ? cells_in(text, path, {}).map.section : scene_section();
  });
}

}  // namespace gatewalk::lattice
