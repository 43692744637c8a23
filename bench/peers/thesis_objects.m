% The design of the thesis: one object per bacterium, an occupancy grid, and a sequential loop over the bacteria
% (theory A1-A4). octave-cli thesis_objects.m SCENE ITERATIONS AGENTS... prints a JSON line per size.
1;

function grid = iterate(bacteria, grid, k, scene)
  sign = 1 - 2 * (mod(k, 2 * scene.hold) >= scene.hold);
  for i = 1:numel(bacteria)
    b = bacteria{i};
    if mod(k, scene.hold) == 0
      b.changeSpeed(scene.basic_noise, sign * scene.drift(1), sign * scene.drift(2));
    end
    [x0, y0] = b.getPos();
    [x, y] = b.nextPos(grid);
    grid(y0, x0) = false;
    grid(y, x) = true;
    b.setPos(x, y);
  end
end

arguments = argv();
addpath(fileparts(mfilename("fullpath")));
scene = jsondecode(arguments{1});
iterations = str2double(arguments{2});
rand("twister", 1);
for n = cellfun(@str2double, arguments(3:end))'
  at = find(scene.sizes(:, 1) == n);
  grid = false(scene.sizes(at, 3), scene.sizes(at, 2));
  bacteria = cell(n, 1);
  for i = 1:n
    do
      x = randi(columns(grid));
      y = randi(rows(grid));
    until !grid(y, x)
    grid(y, x) = true;
    bacteria{i} = Bacterium(x, y);
  end
  ns = zeros(1, iterations);
  for k = 0:iterations - 1  % each iteration is a repeat; every scene.hold-th iteration draws speeds
    start = tic;
    grid = iterate(bacteria, grid, k, scene);
    ns(k + 1) = toc(start) * 1e9 / n;
  end
  pairs = mean(reshape(ns, scene.hold, []), 1);
  vx = cellfun(@(b) b.vx, bacteria);
  variance = scene.basic_noise * (scene.basic_noise + 1) / 3;
  mean_vx = -scene.drift(1) * (1 - 2 * (mod(iterations - 1, 2 * scene.hold) < scene.hold));
  checks = {struct("what", "mean vx", "value", mean(vx), "expected", mean_vx, "tolerance", 5 * sqrt(variance / n)), ...
            struct("what", "var vx", "value", var(vx, 1), "expected", variance, "tolerance", ...
                   5 * variance * sqrt(0.8 / n)), ...
            struct("what", "occupied sites", "value", nnz(grid), "expected", n, "tolerance", 0)};
  for i = 1:numel(checks)
    checks{i}.ok = abs(checks{i}.value - checks{i}.expected) <= checks{i}.tolerance;
  end
  q = quantile(pairs, [0.25, 0.5, 0.75], 2);
  disp(jsonencode(struct("kind", "thesis", "model", "basic", "agents", n, "order", "published", "threads", 1, "ns", q(2), ...
                         "ns_low", q(1), "ns_high", q(3), "repeats", numel(pairs), "checks", {checks})));
end
