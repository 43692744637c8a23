#pragma once
#include <string>

#include "study/plot/plot.h"

namespace faba {

/// A plot with heading and caption.
struct Figure {
  std::string heading, caption;  ///< plain text
  Plot plot;
};

/// <figure> element for a page. `number`: figure number before the caption; 0: none.
std::string figure_markup(const Figure& figure, int number = 0);

}  // namespace faba
