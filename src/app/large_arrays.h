#pragma once
// How memory is taken from the system: large arrays in large pages, and given back when they are freed.

namespace tsubu::app {

/// Gives what is freed back to the system; to be called before anything large is allocated. Large pages for what steps read need no call:
/// rows and columns are aligned, and the `operator new` of aligned types is replaced by ours.
void returnLargeArrays();

}  // namespace tsubu::app
