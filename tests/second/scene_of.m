% SPDX-License-Identifier: MIT
function p = scene_of(words)
  % The paper's field (units m, kg, s, N, rad), changed by words such as "propulsion=8". Beams: left, right.
  p = struct("mass", 1, "radius", 10, "length", 25, "beam_mass", 0.1, "k_left", 400, "k_right", 400, ...
             "damping", 50, "joint_x", 25, "joint_y", 30, "propulsion", 7, "random", 50, "rate", 50, ...
             "drag", 0.06, "restitution", 0.8, "tip", 1, "time", 12, "top", 60, "vy", 15, ...
             "columns", 9, "rows", 9, "most", 13, "step", 0.0005);
  for word = words
    part = strsplit(word{1}, "=");
    if !isfield(p, part{1}) error("no number '%s'", part{1}); end
    p.(part{1}) = str2double(part{2});
  end
  p.inertia = p.beam_mass * p.length ^ 2 / 3;
  p.hold = round(1 / (p.rate * p.step));  % steps of one draw
end
