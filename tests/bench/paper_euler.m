% SPDX-License-Identifier: MIT
% octave paper_euler.m [TRIALS]: the paper's scheme as its text gives it (ours: dynamics/disc/methods/paper.cpp),
% one gate from rest, a plain loop. Prints condition,trials,seconds,steps,traversed,exited,trapped.
1;

% One beam, seen in its own frame: joint at 0, x towards the gate's middle, theta > 0 forward.
% q: place and velocity of the disc in that frame; b: theta, omega.
function t = look(q, b, L, R)
  along = [cos(b(1)), sin(b(1))];
  s = min(max(q(1:2)*along', 0), L);          % contact point from the joint
  away = q(1:2) - s*along;
  t.distance = norm(away);
  t.n = away/t.distance;
  t.lever = s*(along(1)*t.n(2) - along(2)*t.n(1));
  t.gap = t.distance - R;
  t.u = q(3:4)*t.n' - t.lever*b(2);
  t.tip = s == L;
  t.pin = s == 0;
  if t.tip                                    % d^2 gap/dt^2 by motion alone, Eq. (13)
    r = q(3:4) - L*b(2)*[-along(2), along(1)];
    t.bias = (r(1)*t.n(2) - r(2)*t.n(1))^2/t.distance + L*b(2)^2*(t.n*along');
  else                                        % Eq. (11)
    side = sign(t.lever);
    t.bias = -2*side*b(2)*(q(3:4)*along') - b(2)^2*t.distance;
  end
end

function [outcome, step] = one_trial(F, Rm, k)
  M = 1; R = 10; L = 25; I = 0.1*L^2/3; d = 50; dt = 0.004; e = 0.8; epsilon = 0.04; steps = 3000;
  mirror = [1, -1];                           % left, right beam
  q = [0, 0, 0, 0];                           % x, y, vx, vy
  beam = zeros(2, 2);                         % theta, omega
  held = [false, false];
  for step = 1:steps
    if mod(step, 5) == 1
      force = [Rm*randn, F];                  % Eq. (1), held for 0.02 s
    end
    for i = 1:2                               % collisions, left beam first
      if !held(i) && q(2) + R < 30 + L*min(0, beam(i,1))
        continue                              % behind all of the beam
      end
      side = [mirror(i), 1, mirror(i), 1];
      t = look(side.*q + [25, -30, 0, 0], beam(i,:), L, R);
      if t.pin
        held(i) = false;                      % no formula in the paper
      elseif !held(i) && t.gap < 0 && t.u < 0
        J = -(1 + restitution(t.tip, e))*t.u/(1/M + t.lever^2/I);  % Eqs. (4) to (9)
        q(3:4) += side(3:4).*t.n*J/M;
        beam(i,2) -= J*t.lever/I;
        if J < epsilon && t.lever != 0        % a constraint from now on, Eqs. (10), (12)
          held(i) = true;
          beam(i,2) = t.n*(side(3:4).*q(3:4))'/t.lever;
        end
      end
    end
    push = [0, 0]; n = zeros(2, 2); lever = [0, 0];
    if any(held)
      b = [0; 0];
      for i = 1:2
        side = [mirror(i), 1, mirror(i), 1];
        t = look(side.*q + [25, -30, 0, 0], beam(i,:), L, R);
        n(i,:) = t.n.*side(3:4); lever(i) = t.lever;
        b(i) = n(i,:)*force'/M + lever(i)*(k(i)*beam(i,1) + d*beam(i,2))/I + t.bias;
      end
      W = n*n'/M + diag(lever.^2/I);
      push(held) = -W(held,held)\b(held);
      if any(push < 0)                        % a force that would pull releases its contact
        held &= push >= 0;
        push = [0, 0];
        push(held) = max(0, -W(held,held)\b(held));
      end
    end
    accelerations = (force + push*n)/M;
    beta = (-k.*beam(:,1)' - d*beam(:,2)' - lever.*push)/I;
    q += dt*[q(3:4), accelerations];
    beam += dt*[beam(:,2), beta'];
    if q(2) > 65
      outcome = 1; return
    elseif abs(q(1)) > 25
      outcome = 2; return
    end
  end
  outcome = 3;
end

function e = restitution(tip, e)
  if tip
    e = 1;                                    % Eq. (6)
  end
end

trials = 20;
if !isempty(argv())
  trials = str2double(argv(){end});
end
randn("seed", 1);
for condition = {{"A", 8, [400, 400]}, {"B", 7, [300, 500]}}
  [name, F, k] = condition{1}{:};
  ends = [0, 0, 0]; steps = 0;
  begin = cputime;
  for trial = 1:trials
    [outcome, taken] = one_trial(F, 10, k);
    ends(outcome)++; steps += taken;
  end
  printf("%s,%d,%.6g,%d,%d,%d,%d\n", name, trials, cputime - begin, steps, ends);
end
