#pragma once
#include <string>
#include <vector>

#include "study/plot/plot.h"

namespace faba {

/// A plot with heading and caption.
struct Figure {
  std::string heading, caption;  ///< plain text
  Plot plot;
};

/// <figure> element for a page. `number`: figure number before the caption; 0: none. A figure without values
/// is replaced by a sentence.
std::string figure_markup(const Figure& figure, int number = 0);
/// The same of several figures, with numbers after `number`, the last number on the page; counted on. A
/// figure without values has no number.
std::string figures_markup(const std::vector<Figure>& figures, int& number);

}  // namespace faba
