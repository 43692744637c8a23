% The three models in Octave with array operations.
% octave-cli octave_agents.m SCENE SECONDS AGENTS... prints a JSON line per case; SCENE is the first line printed by
% bench_agents. In pixels, seconds and iterations.
1;

function s = new_swarm(scene, model, n, exclusion)
  at = find(scene.sizes(:, 1) == n);
  s = struct("model", model, "n", n, "exclusion", exclusion, "index", 0, "width", scene.sizes(at, 2), ...
             "height", scene.sizes(at, 3));
  s.cell = randperm(s.width * s.height, n)';
  s.x = mod(s.cell - 1, s.width);
  s.y = floor((s.cell - 1) / s.width);
  s.occupied = false(s.width * s.height, 1);
  s.occupied(s.cell) = true;
  s.claim = zeros(s.width * s.height, 1);
  s.vx = s.vy = zeros(n, 1);
  if strcmp(model, "adapted")
    s.speed = randi([0, scene.adapted_noise], n, 1);
  elseif strcmp(model, "dipole")
    law = scene.speed_px_per_s;
    s.speed = law(1) + law(2) * randn(n, 1);
    while any(bad = s.speed < 0 | s.speed > law(3))
      s.speed(bad) = law(1) + law(2) * randn(sum(bad), 1);
    end
    s = set_heading(s, pi * (2 * rand(n, 1) - 1));
  end
end

function s = set_heading(s, theta)
  s.theta = theta;
  s.ux = cos(theta);
  s.uy = sin(theta);
end

function s = redraw(s, scene)
  sign = 1 - 2 * (mod(s.index, 2 * scene.hold) >= scene.hold);
  m = sign * scene.drift;
  if strcmp(s.model, "basic")
    k = scene.basic_noise;
    s.vx = randi(2 * k + 1, s.n, 1) - k - 1 + m(1);
    s.vy = randi(2 * k + 1, s.n, 1) - k - 1 + m(2);
  else
    k = scene.adapted_noise;
    u = m / norm(m);  % the Earth's field included
    s.vx = randi(2 * k + 1, s.n, 1) - k - 1 + s.speed * u(1);
    s.vy = randi(2 * k + 1, s.n, 1) - k - 1 + s.speed * u(2);
  end
end

function [s, x, y] = swim(s, scene)
  dt = scene.dt_s;
  w = scene.w_per_s;
  half = 0.5 * s.theta;  % the field lies along x
  turned = 2 * atan2(sin(half) * exp(-w * dt / 2), cos(half) * exp(w * dt / 2));
  a = 2 * w * dt * cos(turned);
  relaxed = -expm1(-a) ./ a;
  relaxed(abs(a) < 1e-6) = 1;
  theta = turned + sqrt(2 * scene.d_r_per_s * dt * min(relaxed, 20)) .* randn(s.n, 1);
  ux = s.ux;
  uy = s.uy;
  s = set_heading(s, mod(theta + pi, 2 * pi) - pi);
  sd = sqrt(2 * scene.d_t_px2_per_s * dt);
  reach = 0.5 * dt * s.speed;
  x = s.x + reach .* (ux + s.ux) + sd * randn(s.n, 1);
  y = s.y + reach .* (uy + s.uy) + sd * randn(s.n, 1);
end

function s = step(s, scene)
  if strcmp(s.model, "dipole")
    [s, x, y] = swim(s, scene);
  else
    if mod(s.index, scene.hold) == 0
      s = redraw(s, scene);
    end
    x = s.x + s.vx;
    y = s.y + s.vy;
  end
  x = min(max(x, 0), s.width - 1);
  y = min(max(y, 0), s.height - 1);
  if s.exclusion
    s = resolve(s, x, y);
  else
    s.x = x;
    s.y = y;
  end
  s.index += 1;
end

function s = resolve(s, x, y)
  % Simultaneous moves: cells claim free pixels in random order, and the last claim wins.
  wish = floor(y + 0.5) * s.width + floor(x + 0.5) + 1;
  hopeful = find(!s.occupied(wish));
  shuffled = hopeful(randperm(numel(hopeful)));
  s.claim(wish(shuffled)) = shuffled;
  winner = hopeful(s.claim(wish(hopeful)) == hopeful);
  s.occupied(s.cell(winner)) = false;
  s.occupied(wish(winner)) = true;
  s.cell(winner) = wish(winner);
  moved = find(s.cell == wish);
  s.x(moved) = x(moved);
  s.y(moved) = y(moved);
end

function c = check(what, value, expected, tolerance)
  c = struct("what", what, "value", value, "expected", expected, "tolerance", tolerance, "ok", ...
             abs(value - expected) <= tolerance);
end

function all = checks(s, scene)
  % The checks of bench_agents, with a tolerance of five standard errors.
  all = {};
  if strcmp(s.model, "dipole")
    k = scene.alignment;
    mean_cos = besseli(1, k, 1) / besseli(0, k, 1);
    sd = sqrt(1 - mean_cos / k - mean_cos ^ 2);
    all{end + 1} = check("1 - <cos>", mean(1 - s.ux), 1 - mean_cos, 5 * sd / sqrt(s.n) + 1e-3 * (1 - mean_cos));
  else
    k = scene.([s.model "_noise"]);
    v = {s.vx, s.vy};
    name = {"vx", "vy"};
    for i = 1:2
      m = scene.drift(i);
      u = m / norm(scene.drift);
      if strcmp(s.model, "basic")
        expected = -m;
        variance = k * (k + 1) / 3;
      else
        expected = -u * k / 2;
        variance = k * (k + 1) / 3 + u ^ 2 * k * (k + 2) / 12;
      end
      d = v{i} - mean(v{i});
      all{end + 1} = check(["mean " name{i}], mean(v{i}), expected, 5 * sqrt(variance / s.n));
      all{end + 1} = check(["var " name{i}], mean(d .^ 2), variance, 5 * sqrt((mean(d .^ 4) - mean(d .^ 2) ^ 2) / s.n));
    end
  end
  if s.exclusion
    all{end + 1} = check("occupied sites", numel(unique(floor(s.y + 0.5) * s.width + floor(s.x + 0.5))), s.n, 0);
  end
end

function [s, ns] = measure(saved, scene, seconds, least)
  % ns per agent-step of each repeat; each starts from the saved state and runs one cycle before the measurement.
  steps = 24;
  if saved.n >= 1e5
    steps = 8;
  end
  ns = [];
  begin = tic;
  while numel(ns) < least || toc(begin) < seconds
    s = saved;
    for i = 1:2 * scene.hold
      s = step(s, scene);
    end
    start = tic;
    for i = 1:steps
      s = step(s, scene);
    end
    ns(end + 1) = toc(start) * 1e9 / steps / s.n;
  end
end

arguments = argv();
scene = jsondecode(arguments{1});
scene.drift = scene.drift(:)';
rand("twister", 1);
randn("twister", 1);
for n = cellfun(@str2double, arguments(3:end))'
  for model = {"basic", "adapted", "dipole"}
    headings = [];
    for exclusion = [false, true]
      s = new_swarm(scene, model{1}, n, exclusion);
      if strcmp(model{1}, "dipole")
        if isempty(headings)
          for i = 1:scene.settling
            s = swim(s, scene);
          end
          headings = s.theta;
        end
        s = set_heading(s, headings);
      end
      [s, ns] = measure(s, scene, str2double(arguments{2}), 3);
      order = {"none", "two-phase"};
      q = quantile(ns, [0.25, 0.5, 0.75], 2);
      disp(jsonencode(struct("kind", "octave", "model", s.model, "agents", n, "order", order{1 + exclusion}, "threads", 1, ...
                             "ns", q(2), "ns_low", q(1), "ns_high", q(3), "repeats", numel(ns), "checks", ...
                             {checks(s, scene)})));
    end
  end
end
