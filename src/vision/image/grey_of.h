#pragma once

namespace faba {

/// Grey value of a colour in any scale: 0.2989 R + 0.5870 G + 0.1140 B (theory A13). The weights sum to
/// 0.9999, so equal channels return their value unchanged: a grey picture is the same when saved as grey or
/// as colour.
inline float grey_of(float r, float g, float b) {
  return r == g && g == b ? r : 0.2989F * r + 0.5870F * g + 0.1140F * b;
}

}  // namespace faba
