#pragma once

namespace ensonify::cli {

/// From now on SIGINT and SIGTERM only set a flag; a second one ends the program at once.
void watch_signals();
/// The signal that came, 0 if none.
int caught_signal();

}  // namespace ensonify::cli
