% SPDX-License-Identifier: MIT
% Gate, chain and field of the paper, a second time: written from the model alone, in Octave, for comparison.
%   octave second.m gate|chain|field RUNS SEED FILE.csv [NUMBER=VALUE ...]
% gate: runs from (0, 0) with the speed vy; lines ending,runs.   chain: runs of every state of Table III; lines
% from,to,runs.   field: trials from the middle of the first row; lines column,row,ending,trials (0 trapped, 2 left,
% 3 right, 1 crossed, 4 cut off; columns and rows from 0).
%   octave second.m predict COUNTS.csv RESAMPLES SEED FILE.csv [NUMBER=VALUE ...]
% Final gates by the chain of such counts (from,to,runs): lines column,row,share,error (standard error of the
% share by so many draws of the counts anew).
addpath(fileparts(mfilename("fullpath")));
1;

function tally(file, head, table)
  [lines, ~, which] = unique(table, "rows");
  out = fopen(file, "w");
  fprintf(out, "%s\n", head);
  form = [repmat("%d,", 1, columns(lines)), "%d\n"];
  fprintf(out, form, [lines, accumarray(which, 1)]');
  fclose(out);
end

% Runs in parts that fit a processor's cache.
function [ending, q, draw, age] = run(p, q, draw, age)
  ending = zeros(1, columns(q));
  for first = 1:4000:columns(q)
    part = first:min(first + 3999, columns(q));
    [ending(part), q(:, part), draw(part), age(part)] = run_gates(p, q(:, part), draw(part), age(part));
  end
end

words = argv();
what = words{1};
counts_file = "";
if strcmp(what, "predict") counts_file = words{2}; words(2) = []; end
[n, seed, file] = deal(str2double(words{2}), str2double(words{3}), words{4});
p = scene_of(words(5:end)');
randn("twister", seed); rand("twister", seed + 1); randp("twister", seed + 2);
fresh = @(n) deal(zeros(1, n), repmat(p.hold, 1, n));  % a draw at once
switch what
  case "gate"
    [draw, age] = fresh(n);
    ending = run(p, repmat([0; 0; 0; p.vy], 1, n), draw, age);
    tally(file, "ending,runs", ending');
  case "chain"
    t = table3();
    low = repelem(t(:, 2:2:6)', 1, n); high = repelem(t(:, 3:2:7)', 1, n);
    from = repelem(1:rows(t), n);
    side = t(from, 1)';
    at = low + (high - low) .* rand(3, numel(from));
    q = zeros(4, numel(from));
    q(1, :) = at(1, :) .* (side == 1) + p.joint_x * (mod(side, 2) == 0) - p.joint_x * (side == 3 | side == 5);
    q(2, :) = (p.joint_y - at(1, :)) .* (side != 1);
    q(3:4, :) = at(2:3, :);
    [draw, age] = fresh(numel(from));
    [ending, q] = run(p, q, draw, age);
    tally(file, "from,to,runs", [from; enter(p, t, ending, q)]');
  case "field"
    t = table3();
    [draw, age] = fresh(n);
    q = repmat([0; 0; 0; p.vy], 1, n);
    gate = repmat([(p.columns - 1) / 2; 0], 1, n);
    final = zeros(3, n);
    live = 1:n;
    for gates = 1:p.most
      [ending, q, draw, age] = run(p, q, draw, age);
      [~, moves, q] = enter(p, t, ending, q);
      next = gate + moves;
      outside = next(1, :) < 0 | next(1, :) >= p.columns | next(2, :) >= p.rows;
      ended = outside | ending == 0 | gates == p.most;
      ending(!outside & ending != 0) = 4;
      final(:, live(ended)) = [gate(:, ended); ending(ended)];
      stay = !ended;
      live = live(stay); gate = next(:, stay); q = q(:, stay); draw = draw(stay); age = age(stay);
      if isempty(live) break; end
    end
    tally(file, "column,row,ending,trials", final');
  case "predict"
    t = table3();
    lines = dlmread(counts_file, ",", 1, 0);
    counts = full(sparse(lines(:, 1), lines(:, 2), lines(:, 3), rows(t), rows(t) + 1));
    share = final_gates(p, t, counts);
    all = zeros([size(share), n]);
    for i = 1:n all(:, :, i) = final_gates(p, t, reshape(randp(counts(:)), size(counts))); end
    [column, row] = meshgrid(0:p.columns - 1, 0:p.rows - 1);
    out = fopen(file, "w");
    fprintf(out, "column,row,share,error\n");
    fprintf(out, "%d,%d,%.15g,%.4g\n", [column(:), row(:), share(:), reshape(std(all, 0, 3), [], 1)]');
    fclose(out);
end
