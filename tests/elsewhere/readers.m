% SPDX-License-Identifier: MIT
% What an Octave or MATLAB user does with gatewalk's files.
pkg load netcdf
t = dlmread('field.mtx', ' ', 3, 0);
n = max(t(:, 1));
P = sparse(t(:, 1), t(:, 2), t(:, 3), n, n);
f = fopen('field.states.csv'); s = textscan(f, '%d %s %s %s %s %s %s', 'Delimiter', ',', 'HeaderLines', 1); fclose(f);
ends = find(!cellfun('isempty', s{7}));
inside = setdiff(1:n, ends);
B = (speye(numel(inside)) - P(inside, inside)) \ P(inside, ends);
for k = 1:numel(ends)
  printf('absorbed %s %.17g\n', s{7}{ends(k)}, full(B(1, k)));
end
r = double(ncread('p.nc', 'count_row')); c = double(ncread('p.nc', 'count_column')); m = double(ncread('p.nc', 'count'));
k = numel(ncread('p.nc', 'trials'));
M = sparse(r + 1, c + 1, m, k, k + 1);
assert(full(sum(M, 2)), double(ncread('p.nc', 'trials')));
printf('counts %d\n', full(sum(sum(M))));
name = ncread('p.nc', 'state_name');
printf('name %s\n', strtrim(name(:, 3)'));
