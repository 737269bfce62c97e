#pragma once

namespace haptrial::analysis {

/// Style of the report, on screen and on paper.
inline constexpr const char* kReportStyle = R"css(
:root { --ink: #1a1a1a; --soft: #5f6368; --line: #dadce0; --accent: #0072b2; --alarm: #b00020; }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 60rem; padding: 2rem 1.5rem 4rem; color: var(--ink);
  background: #fff; font: 16px/1.55 system-ui, "Helvetica Neue", Arial, sans-serif; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 .4rem; overflow-wrap: anywhere; }
h2 { font-size: 1.3rem; margin: 2.8rem 0 .7rem; padding-top: .9rem;
  border-top: 1px solid var(--line); }
h3 { font-size: 1.05rem; margin: 1.6rem 0 .4rem; }
p { margin: .6rem 0; max-width: 46rem; }
.lead { color: var(--soft); }
.banner { margin: 1.2rem 0; padding: .8rem 1rem; border: 2px solid var(--alarm);
  border-radius: 6px; color: var(--alarm); font-weight: 600; }
.lines { margin: 1.2rem 0; padding: 1rem 1.2rem 1rem 2rem; border-left: 4px solid var(--accent);
  background: #f4f8fb; border-radius: 0 6px 6px 0; }
.lines li { margin: .3rem 0; }
.scroll { overflow-x: auto; margin: .8rem 0; }
table { border-collapse: collapse; font-size: .93rem; }
th { text-align: left; font-weight: 600; border-bottom: 2px solid var(--ink);
  vertical-align: bottom; }
th, td { padding: .32rem .9rem .32rem 0; }
td { border-bottom: 1px solid var(--line); vertical-align: top; }
th.n, td.n { text-align: right; font-variant-numeric: tabular-nums; }
figure { margin: 1.4rem 0; }
figure svg { display: block; width: 100%; height: auto; }
figcaption { color: var(--soft); font-size: .9rem; max-width: 46rem; }
details { margin: .8rem 0; }
summary { cursor: pointer; color: var(--accent); }
pre { padding: 1rem; background: #f6f7f8; border-radius: 6px; overflow-x: auto; font-size: .85rem;
  line-height: 1.4; }
.contents ul { columns: 16rem; padding-left: 1.2rem; list-style: none; }
.contents a { color: var(--accent); }
.contents .level-3 { padding-left: 1.2rem; font-size: .93rem; }
@media screen and (max-width: 700px) {
  figure { overflow-x: auto; }
  figure svg { min-width: 40rem; }
}
@media print {
  .contents { display: none; }
  body { max-width: none; padding: 0; font-size: 10.5pt; }
  figure, table, .lines, .banner { break-inside: avoid; }
  h2, h3 { break-after: avoid; }
  figure svg { width: 85%; }
}
)css";

}  // namespace haptrial::analysis
