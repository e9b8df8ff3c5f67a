% SPDX-License-Identifier: MIT
function [state, moves, q] = enter(p, t, ending, q)
  % Into the next gate: the state there (88: trapped), the move (2 x n), place and velocity seen from there.
  moves = [(ending == 3) - (ending == 2); ending == 1];
  q(1, :) -= 2 * p.joint_x * moves(1, :);
  q(2, :) -= p.top * moves(2, :);
  above = q(2, :) > p.joint_y;
  side = (ending == 1) + (ending == 2) .* (2 + 2 * above) + (ending == 3) .* (3 + 2 * above);
  d = p.joint_y - q(2, :);
  d(ending == 1) = q(1, ending == 1);
  state = repmat(rows(t) + 1, size(ending));
  for s = 1:5
    own = find(t(:, 1) == s);
    of = find(side == s);
    if isempty(of) continue; end
    % How far outside of each bin, in all three numbers: the nearest one.
    off = zeros(numel(own), numel(of));
    numbers = {d(of), q(3, of), q(4, of)};
    for i = 1:3
      off += max(0, max(t(own, 2 * i) - numbers{i}, numbers{i} - t(own, 2 * i + 1)));
    end
    [~, which] = min(off, [], 1);
    state(of) = own(which);
  end
end
