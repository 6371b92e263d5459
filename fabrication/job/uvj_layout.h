#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "fabrication/job/job.h"
#include "fabrication/job/member_place.h"

namespace mezzotint {

// The layout of a .uvj archive.
//
// Standard config.json, slice/%08d.png (8-bit gray, row 0 on top), preview/tiny.png and preview/huge.png; lengths
//          in mm, times in s, speeds in mm/min. Every layer carries its own Z and exposure.
// Ours     manifest.json, which other programs pass over: what UVJ has no place for (name, printer, exact pixel
//          pitch, which way y runs, gray depth) and the SHA-256 of every other member.
// Z        the height of the layer's upper face, as UVtools writes it. The examples of uv3dp begin at 0 (the
//          lower face); a table that begins at 0 is read that way.
// Source   "UVJ File Format", github.com/ezrec/uv3dp, uvj/README.md; UVtools.Core/FileFormats/UVJFile.cs for what
//          its widest reader and writer does (AntiAliasLevel, names of the moves).

inline const std::string config_member = "config.json";
inline const std::string manifest_member = "manifest.json";
inline const std::string tiny_preview_member = "preview/tiny.png";
inline const std::string huge_preview_member = "preview/huge.png";

/// "slice/00000042.png"
[[nodiscard]] std::string slice_member(std::size_t index);

/// SHA-256 of members by their names.
using MemberHashes = std::map<std::string, std::string>;

/// config.json of a job.
[[nodiscard]] std::string write_config(const Job& job);
/// manifest.json of a job.
[[nodiscard]] std::string write_manifest(const Job& job, const MemberHashes& hashes);

/// The job of a config.json, with layers that have no picture yet.
/// @throws FileError saying which value is missing or wrong; sizes of a layer, and the number of layers, are checked
///         before memory is taken for them.
[[nodiscard]] Job read_config(std::span<const std::byte> text, const MemberPlace& place);

/// Takes over what a manifest.json knows of the job; returns the hashes that it promises.
/// @throws FileError where it is not ours, or disagrees with config.json.
[[nodiscard]] MemberHashes read_manifest(std::span<const std::byte> text, const MemberPlace& place, Job& job);

}  // namespace mezzotint
