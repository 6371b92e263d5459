#pragma once

namespace mezzotint {

/// For a program's start: freed blocks of up to 32 MiB (more glibc does not allow) stay with the process for the next
/// allocation, up to 1 GiB of them. A search allocates the same few images over and over; given back and fetched again
/// each time, their pages cost up to a third of it. Does nothing where the C library is not glibc, or where its
/// MALLOC_… variables say otherwise.
void keep_freed_memory();

}  // namespace mezzotint
