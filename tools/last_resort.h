// How the process ends when nothing else can end it any more.
#pragma once

namespace gltf_radiosity::tools {

/// From here on std::terminate and abort, as libraries call them where they cannot go on, end the process with one line
/// and an exit code: kExitLimit if memory ran out, kExitInternal otherwise; and so do crashes, as of libraries that do
/// not look whether there was memory. Takes no memory itself.
void install_last_resort();

/// The line and the exit code for std::bad_alloc, without taking memory.
int end_without_memory();

}  // namespace gltf_radiosity::tools
