#include "ensonify/reproduction/page.hpp"

#include <fmt/format.h>

#include "ensonify/reproduction/conclusions.hpp"

namespace ensonify {
namespace {

ReportSection conclusion_section(const Findings& found) {
  ReportTable table{"What Lin et al. conclude", {"the paper", "here"}, {}, 2, true};
  ReportSection section{
      "Conclusions",
      {"A verdict is “holds” where the claim is true of every scene, threshold or step that it speaks "
       "of, “does not hold” where of none, and “changes” in between."},
      {},
      {},
      {}};
  for (const Conclusion& c : conclusions_of(found)) {
    table.rows.push_back({c.claim, words(c.verdict)});
    if (!c.measured.empty()) section.parts.push_back({c.claim + ": " + words(c.verdict), {c.measured}, {}, {}});
  }
  section.tables.push_back(std::move(table));
  return section;
}

ReportSection missing_section(const Findings& found) {
  ReportTable table{"Left out of this report", {"what", "why"}, {}, 2, true};
  for (const Missing& lack : found.missing) table.rows.push_back({lack.what, lack.why});
  table.rows.push_back({"the paper's own pings, hand-labelled pairs and survey", "no public copy of them was found"});
  return {"What is missing", {}, {std::move(table)}, {}};
}

}  // namespace

ReportPage page_of(const Findings& found) {
  ReportPage page{"Sonar image filtering for occupancy mapping, reproduced",
                  "Lin, Hinduja, Qadri and Kaess, “Conditional GANs for Sonar Image Filtering with Applications to "
                  "Underwater Occupancy Mapping” (ICRA 2023), made again from nothing on a CPU: data, filters, learned "
                  "filter and maps, each number against the simulator's truth.",
                  found.paper_source.facts,
                  {}};
  page.facts.emplace_back("Scale", found.scale);
  page.sections = {conclusion_section(found), missing_section(found), sonar_section(found), filter_section(found),
                   time_section(found),       map_section(found),     tank_section(found),  beyond_section(found)};
  return page;
}

}  // namespace ensonify
