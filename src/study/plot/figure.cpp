#include "study/plot/figure.h"

#include <fmt/format.h>

#include "study/plot/markup.h"
#include "study/plot/plot_svg.h"

namespace faba {

std::string figure_markup(const Figure& f, int number) {
  if (!has_values(f.plot))
    return fmt::format("<p class=\"note\">{}: there are no values, and the figure is omitted.</p>\n",
                       escape_markup(f.heading));
  const std::string label = number > 0 ? fmt::format("Figure {}. ", number) : "";
  return fmt::format("<figure>\n<h3>{}</h3>\n{}<figcaption>{}{}</figcaption>\n</figure>\n",
                     escape_markup(f.heading), svg(f.plot), label, escape_markup(f.caption));
}

std::string figures_markup(const std::vector<Figure>& figures, int& number) {
  std::string out;
  for (const Figure& f : figures) out += figure_markup(f, has_values(f.plot) ? ++number : 0);
  return out;
}

}  // namespace faba
