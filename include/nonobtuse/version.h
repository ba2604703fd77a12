// Part of nonobtuse, MIT licence.
#pragma once

#define NONOBTUSE_VERSION_MAJOR 0
#define NONOBTUSE_VERSION_MINOR 1
#define NONOBTUSE_VERSION_PATCH 0
#define NONOBTUSE_VERSION "0.1.0"
