#pragma once

#include <filesystem>
#include <functional>

namespace ensonify::cli {

/// From now on SIGINT and SIGTERM end the program at once, with 130 and 143: nothing of its work is on the disk yet.
/// A disk that is full and a reader that has gone become errors of the write, no signals.
void end_at_signals();

/// From now on SIGINT and SIGTERM only set a flag; a second one ends the program at once.
void watch_signals();
/// The signal that came, 0 if none.
int caught_signal();

/// Calls write(), which writes files into `folder`: a signal that comes meanwhile ends the program after it, so that no
/// half of a file is left. Before, takes away the halves that killed processes left there.
void write_unbroken(const std::filesystem::path& folder, const std::function<void()>& write);

}  // namespace ensonify::cli
