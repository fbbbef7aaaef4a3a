// Ctrl-C and SIGTERM ask the bake to stop; a second one kills the process as usual.
#pragma once

namespace gltf_radiosity::tools {

/// Catches the next SIGINT and the next SIGTERM of the process, and ignores that a file grows beyond what is allowed or
/// that nobody reads a pipe any more. A signal that was ignored before (nohup) stays ignored.
void catch_interrupts();

/// The signal that asked to stop, or 0. May be called from any thread.
int interrupted_by();

}  // namespace gltf_radiosity::tools
