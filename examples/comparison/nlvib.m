% octave-cli nlvib.m SRC CASE H: the curve of one structure by NLvib (a folder with its SRC), for measure.py.
% CASE is a folder with M, D, K, W (a column for each stop), k and f (columns of numbers), range (two circular frequencies) and observed
% (a DOF from 1), as text. Prints circular frequency and half peak to peak of the highest point of the curve (NaN
% where that is the last one, before the end of the range), and seconds of the processor.
args = argv();
addpath(args{1}); addpath(fullfile(args{1}, 'MechanicalSystems'));
read = @(name) load('-ascii', fullfile(args{2}, name));
H = str2double(args{3}); samples = 256;
W = read('W'); k = read('k'); f = read('f'); range = read('range'); observed = read('observed');
stops = cell(1, numel(k));
for i = 1:numel(k)
    stops{i} = struct('type', 'unilateralSpring', 'stiffness', k(i), 'gap', 0, 'force_direction', W(:, i));
end
system = MechanicalSystem(read('M'), read('D'), read('K'), stops, f);
n = system.n; low = range(1); high = range(2);
q = (system.K + 1i * low * system.D - low^2 * system.M) \ f;
first = zeros((2 * H + 1) * n, 1);
first(n + (1:2 * n)) = [real(q); -imag(q)];
size_of_q = 10 * max(abs(q)); % about that of the resonance, so that steps are alike in all unknowns
options = struct('Dscale', [size_of_q * ones(size(first)); low], 'dynamicDscale', 0, 'stepmax', 2000, 'dsmax', 0.05 * low, ...
                 'dsmin', 1e-3 * low);
quiet = optimset('Display', 'off', 'Jacobian', 'on', 'MaxIter', 50, 'Updating', 'off'); % its own, with Newton's method in place of Broyden's
begin = cputime();
evalc(['X = solve_and_continue(first, @(x) HB_residual(x, system, H, samples, ''frf''), low, high, 0.01 * low, options, ' ...
       '{}, quiet);']); % which prints
seconds = cputime() - begin;
t = (0:1999)' / 2000 * 2 * pi;
series = [ones(size(t)), reshape([cos(t * (1:H)); sin(t * (1:H))], numel(t), [])];
motion = series * X(observed:n:end - 1, :);
[amplitude, highest] = max((max(motion) - min(motion)) / 2);
if highest == columns(X), amplitude = NaN; end % the continuation ended on its way up
printf('%.12g %.12g %.6g\n', X(end, highest), amplitude, seconds);
clear system; % or Octave 7 ends with an error about an object
