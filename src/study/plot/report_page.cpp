#include "study/plot/report_page.h"

#include <fmt/format.h>

#include "study/plot/markup.h"

namespace faba {
namespace {

// Light mode is the default for print and old browsers; dark-mode colours are those of the plots.
constexpr std::string_view kStyle = R"css(
:root{color-scheme:light dark;--paper:#fff;--ink:#1d2329;--muted:#5c6670;--line:#d9dde1;--soft:#f4f6f7;
--link:#0072b2}
@media screen and (prefers-color-scheme:dark){
:root{--paper:#171b1f;--ink:#e6e9ec;--muted:#a4adb6;--line:#363d44;--soft:#1f2429;--link:#56b4e9}}
*{box-sizing:border-box}
body{margin:0;background:var(--paper);color:var(--ink);
font:16px/1.5 system-ui,"Segoe UI",Roboto,"Helvetica Neue",Arial,"DejaVu Sans",sans-serif;
-webkit-text-size-adjust:100%}
main{max-width:1040px;margin:0 auto;padding:2.2rem 1.2rem 4rem}
h1{font-size:1.05rem;font-weight:600;margin:0;color:var(--muted)}
h2{font-size:1.2rem;margin:2.6rem 0 .8rem;padding-bottom:.3rem;border-bottom:1px solid var(--line)}
h3{font-size:1rem;margin:0 0 .4rem}
p{margin:.5rem 0}
.lead{font-size:1.65rem;line-height:1.3;letter-spacing:-.01em;margin:.5rem 0 .6rem;max-width:54rem;
text-wrap:balance}
.details{font-size:1.08rem;max-width:54rem}
.note{color:var(--muted);font-size:.9rem;max-width:46rem}
.quality{margin:1rem 0 0}
.quality+.note{margin-top:0}
.warning{border-left:4px solid #e69f00;background:var(--soft);padding:.5rem .9rem;margin:1rem 0}
.warning p{margin:0}
.warning dl{display:grid;grid-template-columns:max-content 1fr;gap:.1rem .9rem;margin:.3rem 0 0}
.warning dt{color:var(--muted)}
.warning dd{margin:0;grid-column:2}
.sentence::first-letter{text-transform:uppercase}
.cards{display:grid;grid-template-columns:repeat(auto-fit,minmax(10.5rem,1fr));gap:.8rem;margin:1.6rem 0 0;
padding:0}
.cards div{border:1px solid var(--line);border-radius:.4rem;padding:.6rem .9rem .7rem}
.cards dt{color:var(--muted);font-size:.85rem}
.cards dd{margin:0}
.cards b{display:block;font-size:1.4rem;line-height:1.25;font-weight:600;font-variant-numeric:tabular-nums}
.cards span{color:var(--muted);font-size:.85rem}
.figures{display:grid;grid-template-columns:repeat(2,minmax(0,1fr));gap:2rem 2.2rem;align-items:start}
figure{margin:0;min-width:0}
figure.wide{margin-bottom:1.6rem}
.frames{grid-column:1/-1}
.frames div{display:grid;grid-template-columns:repeat(3,minmax(0,1fr));gap:.4rem .8rem}
.frames p{margin:0;color:var(--muted);font-size:.85rem}
figcaption{color:var(--muted);font-size:.85rem;line-height:1.4;margin-top:.3rem}
.faba-plot{display:block;width:100%;height:auto}
video{display:block;width:100%;height:auto;background:#000;border-radius:.3rem}
table{border-collapse:collapse;width:100%;font-variant-numeric:tabular-nums}
th,td{text-align:left;vertical-align:top;padding:.35rem .8rem .35rem 0;border-bottom:1px solid var(--line)}
th{font-weight:400}
thead th{font-weight:600;border-bottom:2px solid var(--line)}
.numbers tbody th[colspan]{font-weight:600;padding-top:1.1rem}
.numbers th small{display:block;color:var(--muted);font-size:.82rem;line-height:1.35;max-width:34rem}
.numbers td,.numbers thead th+th{text-align:right;white-space:nowrap;padding-right:0;padding-left:1rem}
.numbers td small{display:block;color:var(--muted);font-size:.8rem}
div.wide{overflow-x:auto;width:min(1240px,100vw - 2.4rem);margin-left:50%;transform:translateX(-50%)}
.wide table{width:auto;min-width:min(1000px,100%);margin:0 auto}
.wide .numbers{font-size:.92rem}
.wide .numbers td,.wide .numbers thead th+th{padding-left:.9rem}
.wide .numbers thead th{white-space:normal;vertical-align:bottom;line-height:1.3}
.facts th{color:var(--muted);width:11rem}
.facts td{overflow-wrap:anywhere;padding-right:0}
code,pre{font:.86rem/1.5 ui-monospace,"SF Mono",Menlo,Consolas,"DejaVu Sans Mono",monospace}
pre{background:var(--soft);border:1px solid var(--line);border-radius:.4rem;padding:.8rem 1rem;
overflow-x:auto;margin:.6rem 0}
a{color:var(--link)}
summary{cursor:pointer;color:var(--link)}
@media screen and (max-width:720px){
main{padding:1.3rem .9rem 3rem}
.lead{font-size:1.3rem}
.figures{grid-template-columns:minmax(0,1fr)}
.cards{grid-template-columns:repeat(2,minmax(0,1fr));gap:.6rem}
.cards b{font-size:1.15rem}
.facts th{width:7.5rem}
}
@media print{
@page{margin:16mm}
:root{font-size:10pt}
body{font-size:1rem}
.lead{font-size:1.5rem}
.cards{grid-template-columns:repeat(auto-fit,minmax(9rem,1fr))}
th,td{padding-top:.2rem;padding-bottom:.2rem}
main{max-width:none;padding:0}
.video,summary{display:none}
.figures{gap:1.2rem}
figure,tr,.cards{break-inside:avoid}
h2,h3{break-after:avoid}
.faba-plot,.cards div{print-color-adjust:exact;-webkit-print-color-adjust:exact}
}
)css";

}  // namespace

std::string html_page(std::string_view title, std::string_view body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\" />\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\" />\n"
      "<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n<main>\n{}</main>\n</body>\n</html>\n",
      escape_markup(title), kStyle, body);
}

}  // namespace faba
