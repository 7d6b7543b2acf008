#include "scene/images/picture.hpp"

#include <gif_lib.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <optional>

namespace stromboli::images {
namespace {

/// What the library has not read yet.
struct Source {
    std::string_view bytes;
};

int readFrom(GifFileType* file, GifByteType* to, int wanted) {
    auto& source = *static_cast<Source*>(file->UserData);
    const size_t count = std::min(size_t(std::max(wanted, 0)), source.bytes.size());
    std::memcpy(to, source.bytes.data(), count);
    source.bytes.remove_prefix(count);
    return int(count);
}

struct Close {
    void operator()(GifFileType* file) const { DGifCloseFile(file, nullptr); }
};

/// Decodes the first picture of a file, which an animation begins with, onto the file's canvas.
class GifReader {
  public:
    GifReader(std::string_view bytes, const std::string& name) : name_(name), source_{bytes} {
        int error = 0;
        file_.reset(DGifOpen(&source_, readFrom, &error));
        if (!file_) fail(error);
    }

    Picture read() {
        const auto width = uint64_t(std::max(file_->SWidth, 0)),
                   height = uint64_t(std::max(file_->SHeight, 0));
        requireSize(name_, width, height, 4, source_.bytes.size(), 0);
        Picture picture{uint32_t(width), uint32_t(height), {}};
        values_.assign(picture.texelCount() * 4, 0);
        findImage();
        readRows(picture);
        picture.values = std::move(values_);
        return picture;
    }

  private:
    [[noreturn]] void fail(int error) const {
        const char* why = GifErrorString(error);
        failToDecode(name_, "GIF", why ? why : "the file is damaged");
    }

    void require(int result) const {
        if (result == GIF_ERROR) fail(file_->Error);
    }

    /// Goes to the first picture; what stands before it may say which of its colours is no colour.
    void findImage() {
        for (;;) {
            GifRecordType record;
            require(DGifGetRecordType(file_.get(), &record));
            if (record == IMAGE_DESC_RECORD_TYPE) return require(DGifGetImageDesc(file_.get()));
            if (record == TERMINATE_RECORD_TYPE) failToDecode(name_, "GIF", "it has no picture");
            if (record == EXTENSION_RECORD_TYPE) readExtension();
        }
    }

    void readExtension() {
        int code = 0;
        GifByteType* block = nullptr;
        require(DGifGetExtension(file_.get(), &code, &block));
        while (block) {
            GraphicsControlBlock control;
            if (code == GRAPHICS_EXT_FUNC_CODE &&
                DGifExtensionToGCB(block[0], block + 1, &control) == GIF_OK &&
                control.TransparentColor != NO_TRANSPARENT_COLOR)
                transparent_ = control.TransparentColor;
            require(DGifGetExtensionNext(file_.get(), &block));
        }
    }

    void readRows(Picture& picture) {
        const GifImageDesc& image = file_->Image;
        const ColorMapObject* colors = image.ColorMap ? image.ColorMap : file_->SColorMap;
        if (!colors) failToDecode(name_, "GIF", "it has no colours");
        std::vector<GifPixelType> row(size_t(std::max(image.Width, 1)));
        // Interlaced rows come in four passes.
        constexpr int kFirst[] = {0, 4, 2, 1}, kStep[] = {8, 8, 4, 2};
        const int passes = image.Interlace ? 4 : 1;
        for (int pass = 0; pass < passes; ++pass)
            for (int y = image.Interlace ? kFirst[pass] : 0; y < image.Height;
                 y += image.Interlace ? kStep[pass] : 1) {
                if (DGifGetLine(file_.get(), row.data(), image.Width) == GIF_ERROR)
                    return picture.addFault(build::Shortfall::PicturePart,
                                            "the file is truncated or damaged");
                put(picture, image, y, row, *colors);
            }
    }

    void put(const Picture& picture, const GifImageDesc& image, int y,
             const std::vector<GifPixelType>& row, const ColorMapObject& colors) {
        const int64_t line = int64_t(image.Top) + y;
        if (line < 0 || line >= int64_t(picture.height)) return;
        for (int x = 0; x < image.Width; ++x) {
            const int64_t column = int64_t(image.Left) + x;
            const int color = row[size_t(x)];
            if (column < 0 || column >= int64_t(picture.width) || color >= colors.ColorCount ||
                transparent_ == color)
                continue;
            const GifColorType& c = colors.Colors[color];
            uint8_t* texel = &values_[(size_t(line) * picture.width + size_t(column)) * 4];
            texel[0] = c.Red, texel[1] = c.Green, texel[2] = c.Blue, texel[3] = 255;
        }
    }

    const std::string& name_;
    Source source_;
    std::unique_ptr<GifFileType, Close> file_;
    std::optional<int> transparent_; ///< the colour that is none
    std::vector<uint8_t> values_;
};

} // namespace

Picture decodeGif(std::string_view bytes, const std::string& name) {
    return GifReader(bytes, name).read();
}

} // namespace stromboli::images
