#pragma once

#include <string>

namespace vdbeam {

/// Names and lives of the files that outputs are written to before they get their own name. A
/// writer holds a lock (flock) on its file, which the system drops when the process ends, however
/// it ends.

/// ".NAME.MACHINE-PID-N.tmp", N another one at each call. MACHINE stands for this boot of this
/// machine, in 8 hexadecimal digits; all of its containers share it, and they share its locks.
std::string temporary_name(const std::string& name);

/// Takes the lock of a file that was just created. False where another process has removed the
/// file as a stale one in the moment before.
bool lock_temporary(int descriptor);

/// Removes the files in a folder that dead processes have left: those of this machine that nobody
/// locks, and those of other machines, whose locks may be invisible here, that nobody locks and
/// nobody has written to for a day. `like` is an open file in that folder, just created: its time
/// is that of the file system's clock. Does so once for each folder and process; whatever cannot be
/// removed stays.
void remove_stale_temporaries(const std::string& folder, int like);

/// The same of a folder in which nothing is created, because what is to be there is there already:
/// removes only the files of this machine that nobody locks.
void remove_dead_temporaries(const std::string& folder);

} // namespace vdbeam
