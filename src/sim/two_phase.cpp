#include "sim/two_phase.h"

#include <algorithm>
#include <array>

#include "core/random/splitmix64.h"

namespace faba {
namespace {

constexpr std::int32_t kGranted = -1;
constexpr std::size_t kWishes = 4096;  // agents per block of sorted wishes
constexpr int kSweeps = 8;             // of follow()
// A stripe, three bits per site, fits into the L1 cache. Stripes are larger if their number would exceed
// kMostStripes; they consist of complete words of Sites.
constexpr unsigned kStripeShift = 14;
constexpr std::size_t kMostStripes = 256;

// The wishes for the sites of a stripe.
struct Wanted {
  std::vector<std::uint64_t> once, more;  // wanted at least once, more than once
  void clear(std::size_t words) {
    once.assign(words, 0);
    more.assign(words, 0);
  }
};

}  // namespace

std::uint64_t TwoPhase::priority(std::uint64_t key, std::int32_t cell, std::uint32_t agent) {
  return splitmix64(key ^ (std::uint64_t(std::uint32_t(cell)) << 32 | agent));
}

TwoPhase::TwoPhase(const Grid& grid) : grid_(grid) {
  const std::size_t last = std::size_t(grid.columns) * std::size_t(grid.rows) - 1;
  for (shift_ = kStripeShift; last >> shift_ >= kMostStripes;) ++shift_;
  stripes_ = (last >> shift_) + 1;
}

void TwoPhase::resolve(std::span<const float> x, std::span<const float> y, std::span<float> to_x,
                       std::span<float> to_y, Sites& taken, std::uint64_t key, bool follows, Pool& pool) {
  blocks_ = (x.size() + kWishes - 1) / kWishes;
  wish_.resize(x.size());
  left_.resize(x.size());
  refused_.resize(x.size());
  segment_.resize(blocks_ * stripes_);
  const auto each = [&](std::size_t n, auto&& job) {
    if (blocks_ > 1) return pool.run(n, job);
    for (std::size_t i = 0; i < n; ++i) job(i);  // too small for threads
  };
  each(blocks_, [&](std::size_t b) { sort(x, y, to_x, to_y, b); });
  each(stripes_, [&](std::size_t k) { decide(k, taken, key); });
  // After decide(): occupied sites are closed to all wishes. One thread: few agents leave their stripe.
  for (const Segment& s : segment_)
    for (std::uint32_t i = 0; i < s.left; ++i) taken.leave(left_[s.begin + i]);
  if (follows) follow(taken, key);
  each(blocks_, [&](std::size_t b) {
    for (std::size_t k = 0; k < stripes_; ++k) {
      const Segment& s = segment(b, k);
      for (std::uint32_t i = 0; i < s.refused; ++i) {
        const Wish& w = wish_[refused_[s.begin + i]];
        if (w.to == kGranted) continue;
        to_x[w.agent] = x[w.agent];
        to_y[w.agent] = y[w.agent];
      }
    }
  });
}

// Agents that stay on their site are sorted into an additional stripe that is not read: this avoids a branch
// that is often mispredicted.
void TwoPhase::sort(std::span<const float> x, std::span<const float> y, std::span<const float> to_x,
                    std::span<const float> to_y, std::size_t block) {
  const std::size_t first = block * kWishes, n = std::min(kWishes, x.size() - first);
  std::array<std::int32_t, kWishes> from, to;
  find_sites(grid_, x.subspan(first, n), y.subspan(first, n), from.data());
  find_sites(grid_, to_x.subspan(first, n), to_y.subspan(first, n), to.data());
  const auto stripe = [&from, &to, none = stripes_, shift = shift_](std::size_t i) {
    return from[i] == to[i] ? none : std::size_t(to[i]) >> shift;
  };
  std::array<std::uint32_t, kMostStripes + 2> next{};  // counts, shifted by one entry, then positions
  for (std::size_t i = 0; i < n; ++i) ++next[stripe(i) + 1];
  next[0] = std::uint32_t(first);
  for (std::size_t k = 0; k < stripes_; ++k) {
    next[k + 1] += next[k];
    segment(block, k) = {next[k], next[k + 1]};
  }
  Wish* const wish = wish_.data();
  for (std::size_t i = 0; i < n; ++i) wish[next[stripe(i)]++] = {std::uint32_t(first + i), from[i], to[i]};
}

// Finds the sites that are wanted once and more than once; a single wish is granted, and only the others are
// compared. Loops over all wishes have no branches, which would often be mispredicted.
void TwoPhase::decide(std::size_t stripe, Sites& taken, std::uint64_t key) {
  const auto first = std::int32_t(stripe << shift_);
  const Wish* const wish = wish_.data();
  static thread_local Wanted wanted;
  wanted.clear((std::size_t{1} << shift_) / 64);
  std::uint64_t *const once = wanted.once.data(), *const more = wanted.more.data(),
                       *const full = &taken.word(first);
  std::size_t wishes = 0;
  for (std::size_t b = 0; b < blocks_; ++b) {
    const Segment s = segment(b, stripe);
    wishes += s.end - s.begin;
    for (std::uint32_t i = s.begin; i < s.end; ++i) {
      const auto site = std::size_t(wish[i].to - first), w = site >> 6;
      const std::uint64_t bit = std::uint64_t{1} << (site & 63), before = once[w];
      more[w] |= before & bit;
      once[w] = before | bit;
    }
  }
  static thread_local std::vector<std::uint32_t> contested, best;
  if (contested.size() < wishes) contested.resize(wishes);
  if (best.size() >> shift_ == 0) best.resize(std::size_t{1} << shift_);
  std::uint32_t* const contest = contested.data();
  std::size_t contests = 0;
  for (std::size_t b = 0; b < blocks_; ++b) {
    Segment& s = segment(b, stripe);
    std::int32_t* const left = &left_[s.begin];
    std::uint32_t* const others = &refused_[s.begin];
    std::uint32_t granted = 0;
    for (std::uint32_t i = s.begin, end = s.end, k = 0; i < end;
         ++i, ++k) {  // written to both lists; only one index advances
      const auto site = std::size_t(wish[i].to - first), w = site >> 6;
      const std::uint64_t alone = ~(full[w] | more[w]) >> (site & 63) & 1;
      left[granted] = wish[i].from;
      others[k - granted] = i;
      granted += std::uint32_t(alone);
      full[w] |= alone << (site & 63);
    }
    std::uint32_t refused = 0;
    for (std::uint32_t k = 0; k < s.end - s.begin - granted; ++k) {
      const std::uint32_t i = others[k];
      const bool closed = taken.taken(wish[i].to);
      others[refused] = i;
      contest[contests] = i;
      refused += closed;
      contests += !closed;
    }
    s.left = granted;
    s.refused = refused;
  }
  const auto best_for = [&](std::uint32_t i) -> std::uint32_t& {
    return best[std::size_t(wish[i].to - first)];
  };
  const auto rank = [&](std::uint32_t i) { return priority(key, wish[i].to, wish[i].agent); };
  for (const std::uint32_t i : std::span(contest, contests)) best_for(i) = i;
  for (const std::uint32_t i : std::span(contest, contests))
    if (rank(i) < rank(best_for(i))) best_for(i) = i;
  for (const std::uint32_t i : std::span(contest, contests)) {
    Segment& s = segment(wish[i].agent / kWishes, stripe);
    taken.take(wish[i].to);
    if (best_for(i) == i)
      left_[s.begin + s.left++] = wish[i].from;
    else
      refused_[s.begin + s.refused++] = i;
  }
  leave(stripe, taken);
}

// All wishes for this stripe are decided, so its sites can be left; those in other stripes stay in the list.
void TwoPhase::leave(std::size_t stripe, Sites& taken) {
  for (std::size_t b = 0; b < blocks_; ++b) {
    Segment& s = segment(b, stripe);
    std::int32_t* const left = &left_[s.begin];
    std::uint32_t others = 0;
    for (std::uint32_t i = 0; i < s.left; ++i) {
      const std::int32_t site = left[i];
      if (std::size_t(site) >> shift_ == stripe)
        taken.leave(site);
      else
        left[others++] = site;
    }
    s.left = others;
  }
}

// Repeated simultaneous sweeps. Two agents that would swap sites block each other. One thread: few agents are
// affected.
void TwoPhase::follow(Sites& taken, std::uint64_t key) {
  std::vector<Wish*> waiting, winners;
  for (const Segment& s : segment_)
    for (std::uint32_t i = 0; i < s.refused; ++i) waiting.push_back(&wish_[refused_[s.begin + i]]);
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
