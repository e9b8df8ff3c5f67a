% SPDX-License-Identifier: MIT
function t = table3()
  % The states of Table III, a row each: side (1 EN, 2 RD, 3 LD, 4 RT, 5 LT), then low and high of d, vx, vy.
  % RT and LT have one state each: d is 30 - y from -30 to -10, velocities as for RD and LD together.
  t = [];
  ten = @(low, n) low + 10 * (0:n - 1);
  for d = ten(-25, 5) for vx = ten(-25, 5) t(end + 1, :) = [1, d, d + 10, vx, vx + 10, 10, 20]; end; end
  for side = [2, 3]
    for d = [10, 20] for vx = ten(-30 * (side == 2), 3) for vy = ten(-20, 5)
      t(end + 1, :) = [side, d, d + 10, vx, vx + 10, vy, vy + 10];
    end; end; end
  end
  t(end + 1, :) = [4, -30, -10, -30, 0, -20, 30];
  t(end + 1, :) = [5, -30, -10, 0, 30, -20, 30];
end
