#include "app/report/page.hpp"

#include <fmt/format.h>

#include "app/report/plot.hpp"

namespace lodestar {
namespace {

constexpr const char* style = R"(
:root { color-scheme: light dark; --ink: #222; --soft: #777; --line: #ddd; --page: #fff;
  --a: #1f5fbf; --b: #d0342c; --c: #2a8a4a; --band: #9db8dd55; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e6e6; --soft: #9a9a9a; --line: #444; --page: #16181b;
  --a: #6ea8ff; --b: #ff7a70; --c: #6fcf8e; --band: #6ea8ff33; } }
body { font: 15px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--page); max-width: 960px;
  margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.5rem; margin: 0 0 .3rem; } h2 { font-size: 1.1rem; margin: 2rem 0 .5rem; }
p.lead { color: var(--soft); margin: 0 0 1rem; }
table { border-collapse: collapse; width: 100%; } th, td { text-align: right; padding: .3rem .6rem;
  border-bottom: 1px solid var(--line); font-variant-numeric: tabular-nums; }
th:first-child, td:first-child { text-align: left; }
img { width: 100%; border: 1px solid var(--line); background: #fff; }
svg { width: 100%; margin: .6rem 0; break-inside: avoid; }
svg text { fill: var(--ink); font: 12px system-ui, sans-serif; } svg .title { font-size: 14px; font-weight: 600; }
svg .unit, svg .tick { fill: var(--soft); font-weight: 400; } svg .grid { stroke: var(--line); }
.a, .b, .c, .bound { fill: none; stroke-width: 1.3; stroke-linejoin: round; } .a { stroke: var(--a); }
.b { stroke: var(--b); } .c { stroke: var(--c); } .bound { stroke: var(--soft); stroke-dasharray: 4 3; }
.band { fill: var(--band); stroke: none; } .key.a { fill: var(--a); } .key.b { fill: var(--b); }
.key.c { fill: var(--c); } .key.bound { fill: var(--soft); }
)";

}  // namespace

std::string page_html(const std::string& title, const std::string& body) {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width\">"
      "<title>{}</title><style>{}</style></head><body>\n{}</body></html>\n",
      escaped(title), style, body);
}

}  // namespace lodestar
