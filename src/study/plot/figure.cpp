#include "study/plot/figure.h"

#include <fmt/format.h>

#include "study/plot/markup.h"
#include "study/plot/plot_svg.h"

namespace faba {

std::string figure_markup(const Figure& f, int number) {
  const std::string label = number > 0 ? fmt::format("Figure {}. ", number) : "";
  return fmt::format("<figure>\n<h3>{}</h3>\n{}<figcaption>{}{}</figcaption>\n</figure>\n",
                     escape_markup(f.heading), svg(f.plot), label, escape_markup(f.caption));
}

}  // namespace faba
