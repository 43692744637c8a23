#pragma once
#include <string>

#include "study/plot/plot.h"

namespace faba {

/// A plot with the words that belong under it.
struct Figure {
  std::string heading, caption;  ///< plain text
  Plot plot;
};

/// A <figure> element for a page; `number` stands before its caption, 0: none.
std::string figure_markup(const Figure& figure, int number = 0);

}  // namespace faba
