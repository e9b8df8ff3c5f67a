% SPDX-License-Identifier: MIT
function [ending, q, draw, age] = run_gates(p, q, draw, age)
  % Runs of one gate, all at once, by Moreau and Jean's scheme (contact laws on velocities, at the middle of a step).
  % q: 4 x n, place and velocity at the start, then at the end; draw: 1 x n, the random force in action, and
  % age, for how many steps it has been. ending: 0 trapped, 1 over the top, 2 left, 3 right.
  n = columns(q);
  ending = zeros(1, n);
  where = 1:n;  % of those that still run
  [x, y, u, v] = deal(q(1, :), q(2, :), q(3, :), q(4, :));
  f = draw; a = age;
  angle = zeros(2, n); spin = zeros(2, n);
  h = p.step;
  slow = h * p.drag / (2 * p.mass);
  stop = h * p.damping / (2 * p.inertia);
  k = [p.k_left; p.k_right];
  for step = 1:round(p.time / h)
    new = a == p.hold;
    if any(new)
      f(new) = p.random * randn(1, nnz(new));
      a(new) = 0;
    end
    a += 1;
    % The middle of the step, and velocities after it without contact.
    mx = x + h / 2 * u; my = y + h / 2 * v;
    middle = angle + h / 2 * spin;
    free_u = ((1 - slow) * u + h / p.mass * f) / (1 + slow);
    free_v = ((1 - slow) * v + h / p.mass * p.propulsion) / (1 + slow);
    free_spin = ((1 - stop) * spin - h / p.inertia * (k .* middle)) / (1 + stop);
    % The right beam is the left one's image: x is turned round for it.
    c = cos(middle); s = sin(middle);
    rx = [mx; -mx] + p.joint_x;
    ry = my - p.joint_y;
    along = min(max(rx .* c + ry .* s, 0), p.length);
    nx = rx - along .* c; ny = ry - along .* s;
    apart = nx .^ 2 + ny .^ 2;
    near = apart <= p.radius ^ 2;
    hit = find(any(near, 1));
    if !isempty(hit)
      far = sqrt(apart(:, hit));
      tx = nx(:, hit) ./ far; ty = ny(:, hit) ./ far;
      at = along(:, hit);
      lever = at .* (c(:, hit) .* ty - s(:, hit) .* tx);
      e = p.restitution + (p.tip - p.restitution) * (at == p.length);
      sides = [1; -1];
      before = tx .* (sides .* u(hit)) + ty .* v(hit) - lever .* spin(:, hit);
      after = tx .* (sides .* free_u(hit)) + ty .* free_v(hit) - lever .* free_spin(:, hit);
      % Newton's law as complementarity: P >= 0, after + W P + e before >= 0, one of both 0.
      need = after + e .* min(before, 0);
      W = 1 / p.mass + lever .^ 2 / p.inertia;
      both = (ty(1, :) .* ty(2, :) - tx(1, :) .* tx(2, :)) / p.mass;
      P = max(0, -need ./ W) .* near(:, hit);
      one = find(all(near(:, hit), 1));
      if !isempty(one)
        w1 = W(1, one); w2 = W(2, one); w = both(one); n1 = need(1, one); n2 = need(2, one);
        left = n2 + w .* P(1, one) >= 0;
        right = !left & (n1 + w .* P(2, one) >= 0);
        two = !left & !right;
        det = w1 .* w2 - w .^ 2;
        det(!two) = 1;
        P(1, one) = P(1, one) .* left + two .* (w .* n2 - w2 .* n1) ./ det;
        P(2, one) = P(2, one) .* right + two .* (w .* n1 - w1 .* n2) ./ det;
      end
      free_u(hit) += (P(1, :) .* tx(1, :) - P(2, :) .* tx(2, :)) / p.mass;
      free_v(hit) += (P(1, :) .* ty(1, :) + P(2, :) .* ty(2, :)) / p.mass;
      free_spin(:, hit) -= P .* lever / p.inertia;
    end
    x = mx + h / 2 * free_u; y = my + h / 2 * free_v;
    angle = middle + h / 2 * free_spin;
    u = free_u; v = free_v; spin = free_spin;
    out = y > p.top | abs(x) > p.joint_x;
    if any(out)
      gone = where(out);
      ending(gone) = 3 - (x(out) < -p.joint_x) - 2 * (y(out) > p.top & abs(x(out)) <= p.joint_x);
      q(:, gone) = [x(out); y(out); u(out); v(out)];
      draw(gone) = f(out); age(gone) = a(out);
      stay = !out;
      where = where(stay); x = x(stay); y = y(stay); u = u(stay); v = v(stay); f = f(stay); a = a(stay);
      angle = angle(:, stay); spin = spin(:, stay);
      if isempty(where) break; end
    end
  end
end
