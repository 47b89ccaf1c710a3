#include <fmt/format.h>

#include <memory>

#include "ensonify/cli/commands.hpp"
#include "ensonify/cli/progress.hpp"
#include "ensonify/cli/streams.hpp"
#include "ensonify/generators/verify.hpp"

namespace ensonify::cli {

void add_verify(CLI::App& app) {
  auto* command = app.add_subcommand("verify", "Check a dataset: every file, pixel rule and hash against its manifest");
  auto folder = std::make_shared<std::string>();
  auto style = std::make_shared<std::string>("auto");
  command->add_option("DIR", *folder, "Folder of the dataset")->required();
  command->add_option("--progress", *style, "auto, json or none")->check(CLI::IsMember({"auto", "json", "none"}));
  command->footer("Example:\n  ensonify verify out/quick");
  command->callback([folder, style] {
    ProgressLine progress(parse_progress_style(*style));
    const VerifyReport report =
        verify_dataset(*folder, [&](int done, int total) { progress.show("verify", done, done, total); });
    for (const std::string& fault : report.faults) complain(fault);
    if (!report.faults.empty()) {
      complain(
          fmt::format("{} is not as its manifest says; delete the files named and dataset.json, then generate again "
                      "makes them anew",
                      *folder));
      throw ExitCode{1};
    }
    fmt::print("{}: {} frames and {} grids are whole; mask == (clean >= threshold) in every pixel\n", *folder,
               report.frames, report.grids);
  });
}

}  // namespace ensonify::cli
