#include "scene/images/tiff_api.hpp"

#include "host/core/system.hpp"

namespace stromboli::images {
namespace {

TiffApi load() {
    TiffApi api;
    SharedLibrary library("libtiff.so.6", "libtiff6");
    library.find(api.allocateOptions, "TIFFOpenOptionsAlloc");
    library.find(api.freeOptions, "TIFFOpenOptionsFree");
    library.find(api.limitMemory, "TIFFOpenOptionsSetMaxSingleMemAlloc");
    library.find(api.handleErrors, "TIFFOpenOptionsSetErrorHandlerExtR");
    library.find(api.handleWarnings, "TIFFOpenOptionsSetWarningHandlerExtR");
    library.find(api.open, "TIFFClientOpenExt");
    library.find(api.close, "TIFFClose");
    library.find(api.field, "TIFFGetField");
    library.find(api.fieldOrDefault, "TIFFGetFieldDefaulted");
    library.find(api.setField, "TIFFSetField");
    library.find(api.isTiled, "TIFFIsTiled");
    library.find(api.tileAt, "TIFFComputeTile");
    library.find(api.stripAt, "TIFFComputeStrip");
    library.find(api.tileSize, "TIFFTileSize64");
    library.find(api.stripSize, "TIFFVStripSize64");
    library.find(api.readTile, "TIFFReadEncodedTile");
    library.find(api.readStrip, "TIFFReadEncodedStrip");
    library.find(api.isRgbaPossible, "TIFFRGBAImageOK");
    library.find(api.readRgba, "TIFFReadRGBAImageOriented");
    api.missing = library.missing();
    return api;
}

} // namespace

const TiffApi& tiffApi() {
    static const TiffApi api = load();
    return api;
}

} // namespace stromboli::images
