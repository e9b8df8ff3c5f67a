% SPDX-License-Identifier: MIT
function final = final_gates(p, t, counts)
  % The chain of these counts (87 x 88) through the field: the last gate inside, rows x columns.
  matrix = counts ./ max(sum(counts, 2), 1);
  side = t(:, 1);
  here = zeros(p.rows, p.columns, rows(t));
  start = find(side == 1 & t(:, 2) <= 0 & t(:, 3) > 0 & t(:, 4) <= 0 & t(:, 5) > 0);
  here(1, (p.columns + 1) / 2, start) = 1;
  final = zeros(p.rows, p.columns);
  for gates = 1:p.most
    flat = reshape(here, [], rows(t));
    after = reshape(flat * matrix(:, 1:end - 1), size(here));
    moved = zeros(size(here));
    up = side == 1; left = side == 2 | side == 4; right = side == 3 | side == 5;
    moved(2:end, :, up) = after(1:end - 1, :, up);
    moved(:, 1:end - 1, left) = after(:, 2:end, left);
    moved(:, 2:end, right) = after(:, 1:end - 1, right);
    lost = sum(here, 3);  % trapped, or out of the field
    lost(1:end - 1, :) -= sum(after(1:end - 1, :, up), 3);
    lost(:, 2:end) -= sum(after(:, 2:end, left), 3);
    lost(:, 1:end - 1) -= sum(after(:, 1:end - 1, right), 3);
    if gates == p.most lost = sum(here, 3); end
    final += lost;
    here = moved;
  end
end
