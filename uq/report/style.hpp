#pragma once
// The look of report.html: system fonts, one column, light or dark as the reader has it, and a print form. On a narrow
// screen a table's rows are cards, whose cells say what they are. Verdicts carry a word and a sign
// beside their colour (Okabe & Ito).

namespace uq {

inline constexpr const char* report_style = R"css(
:root { color-scheme: light dark; --ink: #1d2126; --soft: #59626c; --rule: #d9dee3; --panel: #f5f7f9; --link: #0060a0;
  --page: #fff; --alarm: #fff6ef; }
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
body { margin: 0 auto; padding: 2.5rem 1.5rem 4rem; max-width: 60rem; color: var(--ink); background: var(--page);
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "DejaVu Sans", sans-serif; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 .3rem; letter-spacing: -.01em; }
h2 { font-size: 1.4rem; line-height: 1.25; margin: 3.2rem 0 .8rem; padding-top: .9rem; border-top: 2px solid var(--ink); }
h3 { font-size: 1.05rem; margin: 2.1rem 0 .6rem; }
p { margin: .55rem 0; max-width: 46rem; }
a { color: var(--link); text-decoration-thickness: 1px; text-underline-offset: 2px; }
h1, h2, h3, p, li, td, th, dd { overflow-wrap: anywhere; }
.lead { font-size: 1.12rem; }
.soft, figcaption, .note { color: var(--soft); }
.note { font-size: .9rem; }
.warnings { border: 2px solid #d55e00; border-left-width: 8px; border-radius: 4px; background: var(--alarm);
  padding: .8rem 1.1rem; margin: 0 0 1.8rem; }
.warnings p { margin: 0 0 .3rem; font-weight: 650; }
.warnings ul { margin: 0; padding-left: 1.2rem; }
.verdict { background: var(--panel); border-radius: 6px; padding: .9rem 1.2rem; margin: .8rem 0 1.2rem; }
.verdict dl { margin: 0; display: grid; grid-template-columns: 8.2rem 1fr; gap: .45rem 1rem; }
.verdict dt { color: var(--soft); }
.verdict dd { margin: 0; }
.verdict dd:first-of-type { font-weight: 600; }
.answers { margin: 1.2rem 0 1.4rem; display: grid; grid-template-columns: max-content 1fr; gap: .6rem 1.2rem; }
.answers dt { font-weight: 650; max-width: 14rem; overflow-wrap: anywhere; }
.answers dd { margin: 0; }
.glossary { display: grid; grid-template-columns: 11rem 1fr; gap: .35rem 1rem; font-size: .93rem; }
.glossary dt { font-weight: 600; }
.glossary dd { margin: 0; max-width: 42rem; }
nav ol { columns: 2; column-gap: 2.5rem; padding-left: 1.3rem; margin: .4rem 0; }
table { border-collapse: collapse; margin: .7rem 0 1rem; font-size: .9rem; font-variant-numeric: tabular-nums; width: 100%; }
caption { text-align: left; color: var(--soft); font-size: .9rem; padding-bottom: .35rem; }
th, td { text-align: left; vertical-align: top; padding: .38rem .7rem .38rem 0; border-bottom: 1px solid var(--rule);
  overflow-wrap: normal; }
thead th { border-bottom: 1.5px solid var(--ink); font-weight: 600; white-space: normal; }
tbody th { font-weight: 600; }
td.number, th.number { text-align: right; white-space: nowrap; }
td.nowrap { white-space: nowrap; }
td.long { overflow-wrap: anywhere; }
.wide { overflow-x: auto; }
.badge { display: inline-block; white-space: nowrap; border: 1.5px solid; border-radius: 1em; padding: 0 .6em;
  font-size: .86rem; font-weight: 600; line-height: 1.55; }
.good { color: #00684c; border-color: #009e73; background: #eefaf5; }
.fair { color: #7a5200; border-color: #e69f00; background: #fff8ea; }
.poor { color: #a34700; border-color: #d55e00; background: #fff3ec; }
.fail { color: #fff; border-color: #1d2126; background: #1d2126; }
figure { margin: 1.1rem 0 1.4rem; break-inside: avoid; }
figure svg { display: block; width: 100%; height: auto; margin: 0 auto; }
figure svg text { font-family: system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "DejaVu Sans", sans-serif; }
figcaption .files { font-size: .78rem; white-space: normal; overflow-wrap: anywhere; }
figcaption { font-size: .9rem; margin-top: .35rem; max-width: 46rem; }
.pair { display: grid; grid-template-columns: repeat(auto-fit, minmax(22rem, 1fr)); gap: .5rem 1.5rem; align-items: start; }
.pair figure { margin: .6rem 0; }
.pair.single { grid-template-columns: minmax(0, 29rem); }
details { margin: .7rem 0; }
summary { cursor: pointer; color: var(--link); }
@media screen and (max-width: 48rem) {
  nav ol { columns: 1; } body { padding: 1.2rem 1rem 3rem; } .pair, .pair.single { grid-template-columns: minmax(0, 1fr); }
  .verdict dl, .answers, .glossary { grid-template-columns: minmax(0, 1fr); gap: .1rem; }
  .verdict dd, .answers dd, .glossary dd { margin-bottom: .6rem; }
  table, caption, tbody, tr, tbody th, td { display: block; }
  thead { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); }
  tr { border-bottom: 1px solid var(--rule); padding: .45rem 0; }
  tbody th, td { border: 0; padding: .08rem 0; }
  tbody th:empty, td:empty { display: none; }
  td.number, th.number { text-align: left; } td.number, td.nowrap { white-space: normal; }
  td[data-label]::before { content: attr(data-label) ": "; color: var(--soft); }
}
@media screen and (prefers-color-scheme: dark) {
  :root { --ink: #e6e9ec; --soft: #a4adb6; --rule: #3a424a; --panel: #20262c; --link: #7cc0f5; --page: #14181c;
    --alarm: #33231a; }
  .good { color: #7fe0bd; background: #10291f; } .fair { color: #f3c766; background: #2e240d; }
  .poor { color: #f7a474; background: #33200f; } .fail { color: #14181c; border-color: #e6e9ec; background: #e6e9ec; }
  figure svg { background: #fff; border-radius: 6px; padding: .4rem; }
}
@media print {
  @page { margin: 18mm 16mm; }
  body { max-width: none; padding: 0; font-size: 10pt; line-height: 1.42; }
  table { font-size: 8.4pt; } td.number, td.nowrap, th.number { white-space: normal; } th, td { padding-right: .4rem; }
  h2 { break-before: auto; break-after: avoid; margin-top: 2rem; } h3, caption { break-after: avoid; }
  tr, .verdict, .warnings { break-inside: avoid; }
  a { color: inherit; text-decoration: none; }
  .badge, .verdict, .warnings { -webkit-print-color-adjust: exact; print-color-adjust: exact; }
  .pair { grid-template-columns: 1fr 1fr; }
  .wide { overflow: visible; }
  details::details-content { content-visibility: visible; display: block; height: auto; }
  figure svg { max-height: 92mm; } h3 + p { break-after: avoid; }
}
)css";

}  // namespace uq
