#pragma once

#include <tiffio.h>

#include <string>

namespace stromboli::images {

/// libtiff's functions, found in its library when they are first wanted: linked with the program,
/// it and the four libraries that it alone needs would be loaded at every start.
struct TiffApi {
    decltype(&::TIFFOpenOptionsAlloc) allocateOptions = nullptr;
    decltype(&::TIFFOpenOptionsFree) freeOptions = nullptr;
    decltype(&::TIFFOpenOptionsSetMaxSingleMemAlloc) limitMemory = nullptr;
    decltype(&::TIFFOpenOptionsSetErrorHandlerExtR) handleErrors = nullptr;
    decltype(&::TIFFOpenOptionsSetWarningHandlerExtR) handleWarnings = nullptr;
    decltype(&::TIFFClientOpenExt) open = nullptr;
    decltype(&::TIFFClose) close = nullptr;
    decltype(&::TIFFGetField) field = nullptr;
    decltype(&::TIFFGetFieldDefaulted) fieldOrDefault = nullptr;
    decltype(&::TIFFSetField) setField = nullptr;
    decltype(&::TIFFIsTiled) isTiled = nullptr;
    decltype(&::TIFFComputeTile) tileAt = nullptr;
    decltype(&::TIFFComputeStrip) stripAt = nullptr;
    decltype(&::TIFFTileSize64) tileSize = nullptr;
    decltype(&::TIFFVStripSize64) stripSize = nullptr;
    decltype(&::TIFFReadEncodedTile) readTile = nullptr;
    decltype(&::TIFFReadEncodedStrip) readStrip = nullptr;
    decltype(&::TIFFRGBAImageOK) isRgbaPossible = nullptr;
    decltype(&::TIFFReadRGBAImageOriented) readRgba = nullptr;

    std::string missing; ///< why libtiff cannot be used; empty: it can
};

/// Loaded at the first call and never unloaded.
const TiffApi& tiffApi();

} // namespace stromboli::images
