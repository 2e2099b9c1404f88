// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace palmar {

/// Style sheet of the HTML report; contrast of text at least 7 to 1, prints on white.
inline constexpr std::string_view kReportStyle = R"(
:root{--ink:#1d2329;--soft:#47515b;--line:#d9dee3;--wash:#f5f7f8;--accent:#8a1f4d}
*{box-sizing:border-box}
body{margin:0;color:var(--ink);background:#fff;font:16px/1.5 system-ui,-apple-system,"Segoe UI",sans-serif}
main,header,footer{max-width:1120px;margin:0 auto;padding:0 24px}
header{padding-top:36px;border-bottom:3px solid var(--accent);padding-bottom:14px}
h1{font-size:1.9rem;line-height:1.2;margin:0}
header p{margin:.4rem 0 0;color:var(--soft)}
h2{font-size:1.45rem;margin:2.6rem 0 .6rem;padding-top:.6rem;border-top:1px solid var(--line)}
h3{font-size:1.1rem;margin:1.8rem 0 .4rem}
a{color:#7a1743}
.wide{overflow-x:auto;margin:.8rem 0}
table{border-collapse:collapse;width:100%;font-size:.92rem}
caption{text-align:left;font-weight:600;padding:.3rem 0}
th,td{padding:.4rem .6rem;border-bottom:1px solid var(--line);text-align:left;vertical-align:top}
thead th.n{white-space:normal}thead th{background:var(--wash);border-bottom:2px solid var(--line);font-weight:600;vertical-align:bottom}
tbody th{font-weight:500}
.range{font-size:.82rem;color:var(--soft)}
.n{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}
tr.total th,tr.total td{font-weight:700;border-top:2px solid var(--line)}
.badge{display:inline-block;padding:.05rem .6rem;border-radius:1rem;font-weight:600;white-space:nowrap}
.good{background:#d9efe3;color:#0b4a2b}.fair{background:#fdecc8;color:#5c3a00}.bad{background:#f8d9dc;color:#6e0f1c}
.swatch{display:inline-block;width:.8em;height:.8em;margin-right:.5em;border:1px solid #6b747d;border-radius:2px}
.note{background:var(--wash);border-left:4px solid var(--accent);padding:.6rem 1rem;margin:.8rem 0}
.note.good{border-left-color:#1d7a4a;background:#eef8f2}.note.fair{border-left-color:#b7791f;background:#fdf3dc}.note.bad{border-left-color:#b3202f;background:#fbe7e9}
.plain{padding-left:1.2rem;margin:.4rem 0}
.cards{display:grid;grid-template-columns:repeat(auto-fit,minmax(240px,1fr));gap:14px;margin:.8rem 0}
.card{border:1px solid var(--line);border-radius:6px;padding:.6rem .8rem;min-width:0;max-width:540px}.card h4{margin:0 0 .4rem;overflow-wrap:anywhere}
.card img{display:block;width:100%;height:auto}
dl{margin:.4rem 0 0;font-size:.92rem}dl div{display:flex;justify-content:space-between;border-top:1px solid var(--line);padding:.15rem 0}dd{margin:0;font-variant-numeric:tabular-nums}
.view{border:1px solid var(--line);border-radius:6px;overflow:hidden;margin:1rem 0}
.view-body{display:grid;grid-template-columns:1fr 120px}
.view-canvas{height:520px;min-width:0;position:relative;display:flex;align-items:center;justify-content:center;background:#fff}
.view-canvas canvas{display:block;width:100%;height:100%;outline-offset:-3px;touch-action:none}
.view-fallback{color:var(--soft);padding:2rem;text-align:center}
.view-bar{padding:14px 8px;font-size:.85rem}
.view-bar svg{display:block}
.controls{display:flex;flex-wrap:wrap;gap:.3rem 1.1rem;align-items:center;padding:.6rem .9rem;background:var(--wash);border-top:1px solid var(--line);font-size:.9rem}
.controls label{white-space:nowrap}
.controls button{font:inherit;padding:.15rem .7rem;border:1px solid #8a949e;border-radius:4px;background:#fff;color:var(--ink);cursor:pointer}
.controls button:hover{border-color:var(--accent)}
:focus-visible{outline:3px solid #0b63c5}
.pictures{display:grid;grid-template-columns:repeat(2,1fr);gap:14px}
figure{margin:0;border:1px solid var(--line);border-radius:6px;overflow:hidden}
figure img{display:block;width:100%;height:auto}
figcaption{font-size:.85rem;color:var(--soft);padding:.3rem .7rem;border-top:1px solid var(--line)}
.charts{display:grid;grid-template-columns:1fr 1fr;gap:24px;align-items:start}.charts svg{width:100%;height:auto}h1,h2,figcaption,code,p{overflow-wrap:anywhere}
details{margin:.8rem 0}summary{cursor:pointer;font-weight:600}
table.indices details{margin:0}table.indices summary{font-weight:500}table.indices details p{margin:.3rem 0;font-weight:400}table.indices thead th:nth-child(2){width:8rem}table.indices thead th:nth-child(3){width:8.5rem}table.indices thead th:nth-child(4){width:9.5rem}
pre{white-space:pre-wrap;font-size:.8rem;background:var(--wash);padding:.8rem;overflow-x:auto}
footer{color:var(--soft);font-size:.88rem;padding-bottom:40px}
@media(max-width:720px){main,header,footer{padding:0 14px}.charts{grid-template-columns:1fr}.wide table{min-width:680px}.view-canvas{height:480px}.view-bar{padding:14px 2px}.pictures{grid-template-columns:1fr}.view-body{grid-template-columns:1fr 104px}}
@media print{body{font-size:11pt}main,header,footer{max-width:none;padding:0}.view{display:none}h2{break-before:page}h2.first{break-before:auto}figure,table{break-inside:avoid}}
)";

}  // namespace palmar
