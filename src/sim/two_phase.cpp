#include "sim/two_phase.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

#include "core/random/splitmix64.h"

namespace faba {
namespace {

constexpr std::int32_t kGranted = -1;
constexpr std::size_t kAgentsAtOnce = 1024;  // their sites fit into the L1 cache
constexpr std::size_t kWords = 2;            // of a block of sites: 128 sites
constexpr unsigned kSiteShift = 7;
constexpr std::size_t kFlags = sizeof(std::uint64_t);  // blocks that are skipped at once
constexpr std::size_t kBlocksAtOnce = 256 * kFlags;
constexpr std::size_t kSmall = 4096;  // agents for which threads do not pay
constexpr unsigned kMostParts = 8;    // each has three bits per site
constexpr int kSweeps = 8;            // of follow()

// Calls use(i, from, to) for the agents [begin, end), where from and to are their sites.
template <class Use>
void each_move(const Grid& grid, std::span<const float> x, std::span<const float> y,
               std::span<const float> to_x, std::span<const float> to_y, std::size_t begin, std::size_t end,
               Use&& use) {
  std::array<std::int32_t, kAgentsAtOnce> from, to;
  for (std::size_t first = begin; first < end; first += kAgentsAtOnce) {
    const std::size_t n = std::min(kAgentsAtOnce, end - first);
    find_sites(grid, x.subspan(first, n), y.subspan(first, n), from.data());
    find_sites(grid, to_x.subspan(first, n), to_y.subspan(first, n), to.data());
    for (std::size_t k = 0; k < n; ++k) use(std::uint32_t(first + k), from[k], to[k]);
  }
}

}  // namespace

std::uint64_t TwoPhase::priority(std::uint64_t key, std::int32_t cell, std::uint32_t agent) {
  return splitmix64(key ^ (std::uint64_t(std::uint32_t(cell)) << 32 | agent));
}

void TwoPhase::resolve(std::span<const float> x, std::span<const float> y, std::span<float> to_x,
                       std::span<float> to_y, Sites& taken, std::uint64_t key, bool follows, Pool& pool) {
  prepare(x.size(), taken.words().size(), x.size() <= kSmall ? 1 : std::min(pool.threads(), kMostParts));
  const auto each_part = [&](auto&& job) {
    if (parts_used_ == 1) return job(parts_[0]);
    pool.run(parts_used_, [&](std::size_t k) { job(parts_[k]); });
  };
  const auto each_block = [&](auto&& job) {
    if (parts_used_ == 1) return job(std::size_t{0}, blocks_);
    pool.for_blocks(blocks_, kBlocksAtOnce, job);
  };
  each_part([&](Part& p) { mark(x, y, to_x, to_y, p); });
  each_block([&](std::size_t first, std::size_t end) { grant(taken, first, end); });
  each_part([&](Part& p) { decide(x, y, to_x, to_y, p); });
  settle(key);
  each_block([&](std::size_t first, std::size_t end) { update(taken, first, end); });
  if (follows) follow(taken, key);
  each_part([&](Part& p) {
    for (const Wish& w : std::span(p.refused).first(p.refusals)) {
      if (w.to == kGranted) continue;
      to_x[w.agent] = x[w.agent];
      to_y[w.agent] = y[w.agent];
    }
  });
}

void TwoPhase::prepare(std::size_t agents, std::size_t words, unsigned parts) {
  words_ = words;
  blocks_ = (words / (kWords * kFlags) + 1) * kFlags;
  parts_.resize(std::max<std::size_t>(parts_.size(), parts));
  parts_used_ = parts;
  for (Sites* s : {&granted_, &wanted_}) s->resize_words(words);
  before_.resize(words);
  for (std::size_t k = 0; k < parts; ++k) {
    Part& p = parts_[k];
    p.begin = agents * k / parts;
    p.end = agents * (k + 1) / parts;
    // One more than the agents: decide() writes each wish to the ends of both lists.
    p.contested.resize(p.end - p.begin + 1);
    p.refused.resize(p.end - p.begin + 1);
    for (Sites* s : {&p.once, &p.more, &p.left}) s->resize_words(words);
    p.used.resize(blocks_);
  }
}

template <class Use>
void TwoPhase::each_used_word(std::size_t first_block, std::size_t end_block, Use&& use) const {
  for (std::size_t first = first_block; first < end_block; first += kFlags) {
    std::uint64_t used = 0;  // a byte per block
    for (std::size_t k = 0; k < parts_used_; ++k) {
      std::uint64_t of_part = 0;
      std::memcpy(&of_part, &parts_[k].used[first], kFlags);
      used |= of_part;
    }
    for (; used != 0; used &= used - 1) {
      const std::size_t block = first + std::size_t(std::countr_zero(used)) / 8;
      for (std::size_t w = block * kWords; w < std::min(words_, (block + 1) * kWords); ++w) use(w);
    }
  }
}

// An agent that stays on its site marks no bit.
void TwoPhase::mark(std::span<const float> x, std::span<const float> y, std::span<const float> to_x,
                    std::span<const float> to_y, Part& part) const {
  std::uint8_t* const used = part.used.data();
  each_move(grid_, x, y, to_x, to_y, part.begin, part.end,
            [&](std::uint32_t, std::int32_t from, std::int32_t to) {
              const std::uint64_t bit = std::uint64_t{from != to} << (to & 63);
              std::uint64_t& once = part.once.word(to);
              part.more.word(to) |= once & bit;
              once |= bit;
              used[from >> kSiteShift] = 1;
              used[to >> kSiteShift] = 1;
            });
}

void TwoPhase::grant(const Sites& taken, std::size_t first_block, std::size_t end_block) {
  each_used_word(first_block, end_block, [&](std::size_t w) {
    std::uint64_t once = 0, more = 0;
    for (std::size_t k = 0; k < parts_used_; ++k) {
      const std::uint64_t of_part = parts_[k].once.words()[w];
      more |= parts_[k].more.words()[w] | (once & of_part);
      once |= of_part;
    }
    const std::uint64_t open = ~taken.words()[w];
    granted_.words()[w] = once & ~more & open;
    wanted_.words()[w] = more & open;
  });
}

// No branches, which would often be mispredicted: each wish is written to both lists, of which at most one
// advances.
void TwoPhase::decide(std::span<const float> x, std::span<const float> y, std::span<const float> to_x,
                      std::span<const float> to_y, Part& part) const {
  Wish *const contested = part.contested.data(), *const refused = part.refused.data();
  std::size_t contests = 0, refusals = 0;
  each_move(grid_, x, y, to_x, to_y, part.begin, part.end,
            [&](std::uint32_t agent, std::int32_t from, std::int32_t to) {
              const std::uint64_t moves = from != to, granted = granted_.word(to) >> (to & 63) & moves,
                                  wanted = wanted_.word(to) >> (to & 63) & moves;
              part.left.word(from) |= granted << (from & 63);
              contested[contests] = refused[refusals] = {agent, from, to};
              contests += wanted;
              refusals += moves & ~(granted | wanted);
            });
  part.contests = contests;
  part.refusals = refusals;
}

// One thread: few wishes are contested.
void TwoPhase::settle(std::uint64_t key) {
  const auto contested = [](const Part& p) { return p.contests > 0; };
  if (std::none_of(parts_.begin(), parts_.begin() + std::ptrdiff_t(parts_used_), contested)) return;
  std::uint32_t sites = 0;
  each_used_word(0, blocks_, [&](std::size_t w) {
    if (wanted_.words()[w] == 0) return;  // popcount is a call
    before_[w] = sites;
    sites += std::uint32_t(std::popcount(wanted_.words()[w]));
  });
  const auto rank = [&](std::int32_t site) {
    const std::uint64_t smaller = wanted_.word(site) & (Sites::bit(site) - 1);
    return std::size_t(before_[std::size_t(site) >> 6]) + std::size_t(std::popcount(smaller));
  };
  best_.assign(sites, std::numeric_limits<std::uint64_t>::max());
  winner_.resize(sites);
  for (const Part& p : std::span(parts_).first(parts_used_))
    for (const Wish& w : std::span(p.contested).first(p.contests)) {
      const std::size_t r = rank(w.to);
      const std::uint64_t mine = priority(key, w.to, w.agent);
      const bool better = mine <= best_[r];
      best_[r] = better ? mine : best_[r];
      winner_[r] = better ? w.agent : winner_[r];
    }
  for (Part& p : std::span(parts_).first(parts_used_))
    for (const Wish& w : std::span(p.contested).first(p.contests)) {
      const std::uint64_t wins = winner_[rank(w.to)] == w.agent;
      p.left.word(w.from) |= wins << (w.from & 63);
      p.refused[p.refusals] = w;
      p.refusals += 1 - wins;
    }
}

// After all decisions: occupied sites are closed to all wishes.
void TwoPhase::update(Sites& taken, std::size_t first_block, std::size_t end_block) {
  each_used_word(first_block, end_block, [&](std::size_t w) {
    std::uint64_t left = 0;
    for (Part& p : std::span(parts_).first(parts_used_)) {
      left |= p.left.words()[w];
      for (Sites* s : {&p.once, &p.more, &p.left}) s->words()[w] = 0;
    }
    taken.words()[w] = (taken.words()[w] & ~left) | granted_.words()[w] | wanted_.words()[w];
    granted_.words()[w] = wanted_.words()[w] = 0;
  });
  for (Part& p : std::span(parts_).first(parts_used_))
    std::fill(&p.used[first_block], &p.used[first_block] + (end_block - first_block), std::uint8_t{0});
}

// Repeated simultaneous sweeps. Two agents that would swap sites block each other. One thread: few agents are
// affected.
void TwoPhase::follow(Sites& taken, std::uint64_t key) {
  std::vector<Wish*> waiting, winners;
  for (Part& p : std::span(parts_).first(parts_used_))
    for (Wish& w : std::span(p.refused).first(p.refusals)) waiting.push_back(&w);
  std::sort(waiting.begin(), waiting.end(), [key](const Wish* a, const Wish* b) {
    return a->to != b->to ? a->to < b->to : priority(key, a->to, a->agent) < priority(key, b->to, b->agent);
  });
  for (int sweep = 1; sweep < kSweeps; ++sweep) {
    winners.clear();
    for (std::size_t i = 0; i < waiting.size(); ++i)
      if ((i == 0 || waiting[i - 1]->to != waiting[i]->to) && !taken.taken(waiting[i]->to))
        winners.push_back(waiting[i]);
    if (winners.empty()) break;
    for (const Wish* w : winners) taken.take(w->to);
    for (Wish* w : winners) {
      taken.leave(w->from);
      w->to = kGranted;
    }
    std::erase_if(waiting, [](const Wish* w) { return w->to == kGranted; });
  }
}

}  // namespace faba
