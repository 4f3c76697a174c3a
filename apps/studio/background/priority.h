// Which threads the processor serves first.
#pragma once

namespace limpid::studio {

/// Lowers the priority of the calling thread, and so that of the threads that it starts: those of a device
/// that computes on the CPU leave the user interface room. Where the system refuses, nothing changes.
void lowerPriority();
/// The same, below those that render.
void lowerPriorityBelowFrames();

}  // namespace limpid::studio
