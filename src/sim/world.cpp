#include "sim/world.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/random/draw_blocks.h"

namespace faba {
namespace {

constexpr std::size_t kBlock = 2048;        // field, headings and positions of a block fit into the L1 cache
constexpr std::uint32_t kAttempts = 20000;  // per cell; reached only if the start region is full

/// Sum and count of candidate positions outside the arena (m, world).
struct OutsidePositions {
  Vec2 sum;
  double count = 0;
};

// Message for a start region without a candidate position inside the arena.
std::string outside_message(const Arena& arena, const OutsidePositions& outside) {
  if (outside.count == 0) return "no position of this start is in the view; use another start";
  const Outline o = arena.outline();
  const Frame f = arena.frame();
  const Vec2 mean = f.image_from_world((1 / outside.count) * outside.sum);
  const std::string walls = o.radius_px > 0
                                ? fmt::format("a circle of radius {:g} px around ({:.0f}, {:.0f}) px",
                                              o.radius_px, o.centre_image.x, o.centre_image.y)
                                : fmt::format("a rectangle of {} x {} px", f.width, f.height);
  return fmt::format(
      "the region around ({:.0f}, {:.0f}) px is outside the arena, {}; move it, or use another start", mean.x,
      mean.y, walls);
}

}  // namespace

World::World(WorldParts parts, Pool& pool)
    : parts_(std::move(parts)), pool_(pool), exclusion_(parts_.exclusion, *parts_.arena, parts_.seed) {
  std::size_t n = 0;
  for (const auto& p : parts_.populations) n = std::max(n, p.end);
  const Grid g = parts_.arena->grid();
  const auto cells = std::size_t(g.columns) * std::size_t(g.rows);
  if (exclusion_.active() && n > cells)
    throw Error(
        Errc::usage, "swarm",
        fmt::format("{} cells do not fit into the arena, which has at most {} pixels, with one cell per "
                    "pixel; use fewer cells, a larger arena, or exclusion.order = \"none\"",
                    n, cells));
  state_.agents = Columns(n);
  for (const auto& p : parts_.populations)
    for (const auto& c : p.model->columns()) state_.agents.add(c.name);
  for (const auto& c : parts_.motility->columns()) state_.agents.add(c.name);
  state_.current.assign(parts_.field->coils(), 0.0);
  state_.command = state_.current;
  for (std::size_t k = 0; k < parts_.field->coils(); ++k) {
    const double lag = parts_.field->circuit(k).lag;
    current_gain_.push_back(lag > 0 ? 1 - portable::exp(-parts_.dt / lag) : 1.0);
  }
  place_all();
  exclusion_.occupy(state_);
  if (exclusion_.active()) {
    to_x_.resize(n);
    to_y_.resize(n);
  }
}

void World::place_all() {
  auto x = state_.agents["x"], y = state_.agents["y"], response = state_.agents["response"];
  for (std::size_t k = 0; k < parts_.populations.size(); ++k) {
    const Population& p = parts_.populations[k];
    bool within = false;  // some candidate was inside the arena
    OutsidePositions outside;
    for (std::size_t i = p.begin; i < p.end; ++i) {
      const auto id = std::uint32_t(i);
      for (std::uint32_t attempt = 0;; ++attempt) {
        if (attempt == kAttempts)
          throw Error(
              Errc::usage, fmt::format("swarm[{}].start", k),
              within ? fmt::format("no free pixel found for cell {} of {}: the region is too small for one "
                                   "cell per pixel; use fewer cells, a larger region, or exclusion.order = "
                                   "\"none\"",
                                   i - p.begin + 1, p.end - p.begin)
                     : outside_message(*parts_.arena, outside));
        const auto w = draw(parts_.seed, kPositionDraws, id, attempt);
        const auto u = [&](int j) { return (double(w[std::size_t(j)]) + 0.5) * 0x1p-32; };
        const auto candidate = p.start->place({{u(0), u(1), u(2)}, i - p.begin, attempt});
        if (!candidate) continue;
        const Vec2 at = exclusion_.snapped(*candidate);
        if (parts_.arena->depth(at) < 0) {
          outside.sum = outside.sum + at;
          outside.count += 1;
          continue;
        }
        within = true;
        if (exclusion_.active() && !exclusion_.place(at)) continue;
        x[i] = float(at.x);
        y[i] = float(at.y);
        break;
      }
      const bool responds =
          (double(draw(parts_.seed, kResponseDraws, id, 0)[0]) + 0.5) * 0x1p-32 < p.responding;
      response[i] = responds ? float(p.polarity) : 0.0f;
    }
    p.model->start(state_, p.begin, p.end, parts_.seed);
    if (p.heading && state_.agents.has("ux")) set_headings(p);
    parts_.motility->start(state_, p.begin, p.end, parts_.seed);
  }
}

void World::set_headings(const Population& p) {
  auto ux = state_.agents["ux"], uy = state_.agents["uy"], response = state_.agents["response"];
  const auto along = portable::sincos(*p.heading);
  for (std::size_t i = p.begin; i < p.end; ++i)
    if (response[i] != 0) {
      ux[i] = float(along.cos);
      uy[i] = float(along.sin);
    }
}

void World::exchange_model(std::size_t population, std::shared_ptr<const AgentModel> model) {
  Population& p = parts_.populations.at(population);
  const bool headed = state_.agents.has("ux");
  std::vector<float> ux, uy;
  const auto keep = [&](const char* name, std::vector<float>& out) {
    const auto column = state_.agents[name].subspan(p.begin, p.end - p.begin);
    out.assign(column.begin(), column.end());
  };
  if (headed) {
    keep("ux", ux);
    keep("uy", uy);
  }
  for (const auto& c : model->columns()) state_.agents.add(c.name);
  model->start(state_, p.begin, p.end, parts_.seed);
  for (std::size_t i = 0; i < ux.size(); ++i) {
    if (ux[i] == 0 && uy[i] == 0) continue;  // its model had no heading
    state_.agents["ux"][p.begin + i] = ux[i];
    state_.agents["uy"][p.begin + i] = uy[i];
  }
  p.model = std::move(model);
}

void World::advance_currents() {
  for (std::size_t k = 0; k < state_.current.size(); ++k)
    state_.current[k] += current_gain_[k] * (state_.command[k] - state_.current[k]);
}

void World::command(const std::vector<double>& current) {
  if (current.size() != parts_.field->coils())
    throw Error(Errc::usage, "command",
                fmt::format("{} currents for {} coils", current.size(), parts_.field->coils()));
  state_.command = current;
}

void World::step() {
  advance_currents();
  const bool proposals = exclusion_.active();
  const std::span<float> to_x = proposals ? std::span<float>(to_x_) : state_.agents["x"];
  const std::span<float> to_y = proposals ? std::span<float>(to_y_) : state_.agents["y"];
  if (parts_.table) parts_.table->set(state_.current);
  const auto speed_factor = float(parts_.motility->speed_factor(state_.t));
  for (const Population& p : parts_.populations)
    pool_.for_blocks(p.end - p.begin, kBlock, [&](std::size_t b, std::size_t e) {
      std::array<float, kBlock> bx, by;
      StepContext c{p.begin + b,        p.begin + e, parts_.seed, parts_.dt,   {bx.data(), e - b},
                    {by.data(), e - b}, to_x,        to_y,        speed_factor};
      const State& s = state_;
      const Points at{s.agents["x"].subspan(c.begin, e - b), s.agents["y"].subspan(c.begin, e - b)};
      const Vectors field{{bx.data(), e - b}, {by.data(), e - b}};
      parts_.table ? parts_.table->eval(at, field) : parts_.field->eval(at, s.current, field);
      parts_.motility->step(state_, c);
      p.model->step(state_, c);
      parts_.arena->confine(state_, c);
    });
  if (proposals) exclusion_.resolve(state_, to_x_, to_y_, pool_);
  ++state_.step;
  state_.t = double(state_.step) * parts_.dt;
}

void World::check_finite() const {
  const auto x = state_.agents["x"], y = state_.agents["y"];
  for (const Population& p : parts_.populations)
    for (std::size_t i = p.begin; i < p.end; ++i)
      if (!std::isfinite(x[i]) || !std::isfinite(y[i]))
        throw Error(
            Errc::internal, fmt::format("cell {}", i),
            fmt::format(
                "position is not finite after step {}; the parameters of swarm[{}].model are outside the "
                "range of validity of the model",
                state_.step, &p - parts_.populations.data()));
}

void World::restore(const State& saved) {
  if (saved.current.size() != state_.current.size())
    throw Error(Errc::input, "checkpoint", "belongs to another scenario");
  state_.assign(saved);
  exclusion_ = Exclusion(parts_.exclusion, *parts_.arena, parts_.seed);
  exclusion_.occupy(state_);
}

std::uint64_t World::responding() const {
  std::uint64_t n = 0;
  for (const float r : state_.agents["response"]) n += r != 0.0f;
  return n;
}

}  // namespace faba
