#include "ensonify/output/report_style.hpp"

namespace ensonify {

std::string_view report_style() {
  // The colours of plots (plot.cpp) are named by their value on white; dark pages put brighter ones in their place.
  return R"css(
:root {
  color-scheme: light dark;
  --paper: #fff; --ink: #1c2024; --quiet: #5a636c; --rule: #d8dde2; --soft: #f5f7f8; --link: #0b5cad;
}
@media screen and (prefers-color-scheme: dark) {
  :root {
    --paper: #14171a; --ink: #e4e7ea; --quiet: #a3adb6; --rule: #363d44; --soft: #1d2226; --link: #7db8f0;
    --c-0072b2: #4fb0ef; --c-d55e00: #ff8a3d; --c-009e73: #2fcb9d; --c-cc79a7: #e59cc5; --c-e69f00: #f2b632;
    --c-56b4e9: #8fd0f7; --c-555555: #b4bac0; --c-cccccc: #4a525a;
  }
}
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
body {
  margin: 0 auto; max-width: 76rem; padding: 2.5rem 1.25rem 4rem; overflow-wrap: break-word;
  font: 1rem/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "Liberation Sans", sans-serif;
  color: var(--ink); background: var(--paper);
}
h1, h2, h3 { line-height: 1.25; font-weight: 600; }
h1 { margin: 0 0 .5rem; font-size: 1.9rem; }
h2 { margin: 3.5rem 0 .75rem; padding-top: .75rem; border-top: 1px solid var(--rule); font-size: 1.4rem; }
h3 { margin: 2.25rem 0 .5rem; font-size: 1.1rem; }
p { margin: 0 0 1rem; max-width: 68ch; }
.lead { font-size: 1.1rem; }
a { color: var(--link); }
nav { margin: 1.5rem 0 0; }
nav ul { display: flex; flex-wrap: wrap; gap: .25rem 1.5rem; margin: 0; padding: 0; list-style: none; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .2rem 1.25rem; margin: 1.25rem 0; font-size: .9rem; }
dt { color: var(--quiet); }
dd { margin: 0; min-width: 0; overflow-wrap: anywhere; }
.missing { max-width: none; padding: .75rem 1rem; border: 1px solid var(--rule); border-left: 4px solid #d55e00; background: var(--soft); }
.figures { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 28rem), 1fr)); gap: 2.5rem 2rem; margin: 1.5rem 0; }
figure { margin: 0; min-width: 0; }
figure.wide { grid-column: 1 / -1; }
figure > svg { display: block; width: 100%; max-width: 34rem; height: auto; }
figure > svg text { font-family: system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "Liberation Sans", sans-serif; }
figure > img { display: block; max-width: 100%; height: auto; padding: 4px; background: #fff; border: 1px solid var(--rule); }
figcaption { margin: .75rem 0; max-width: 72ch; font-size: .9rem; color: var(--quiet); }
figcaption b { color: var(--ink); }
.sheet { font-size: .8rem; color: var(--quiet); }
.sheet .label { margin: 1rem 0 .35rem; font-size: .85rem; font-weight: 600; color: var(--ink); }
.tiles { display: grid; gap: .6rem .75rem; }
.tile { min-width: 0; max-width: 20rem; }
.tile div { display: flex; gap: 2px; border: 1px solid var(--rule); background: var(--rule); }
.tile img { flex: 1 1 0; display: block; min-width: 0; width: 100%; height: auto; }
.tile span { display: block; font-variant-numeric: tabular-nums; }
.scroll { max-width: 100%; margin: .5rem 0 1.25rem; overflow: auto; border: 1px solid var(--rule); border-radius: 4px; }
table { width: 100%; border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums; }
caption { padding: .5rem .7rem; text-align: left; color: var(--quiet); }
caption span { position: sticky; left: .7rem; display: inline-block; max-width: min(60ch, calc(100vw - 4rem)); }
th, td { padding: .3rem .7rem; border-top: 1px solid var(--rule); text-align: right; white-space: nowrap; font-weight: 400; }
thead th { position: sticky; top: 0; z-index: 1; background: var(--soft); font-weight: 600; white-space: normal; vertical-align: bottom; }
tbody th:first-child { position: sticky; left: 0; background: var(--paper); }
thead th.head, tbody th { text-align: left; }
details { margin: .5rem 0 1rem; }
summary { cursor: pointer; font-size: .9rem; color: var(--link); }
details caption { display: none; }
details .scroll { max-height: 32rem; }

@media (max-width: 40rem) {
  thead th.long { min-width: 7rem; }
  body { padding: 1.25rem 1rem 3rem; }
  h1 { font-size: 1.5rem; }
}
@media print {
  @page { margin: 15mm; }
  body { max-width: none; padding: 0; font-size: 10pt; }
  nav, .scroll::-webkit-scrollbar { display: none; }
  h2, h3, .label, summary { break-after: avoid; }
  figure:not(.wide), figcaption, .tile, tr { break-inside: avoid; }
  figcaption { break-before: avoid; }
  .figures { grid-template-columns: 1fr 1fr; gap: 1.5rem; }
  .scroll, details .scroll { max-height: none; overflow: visible; border: 0; }
  thead th, tbody th:first-child { position: static; }
  table { font-size: 7.5pt; }
  th, td { padding: .15rem .35rem; white-space: normal; }
  a { color: inherit; text-decoration: none; }
}
)css";
}

}  // namespace ensonify
