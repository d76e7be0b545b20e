// The book as PDF: A4 landscape, text by pango.
#include <cairo-pdf.h>
#include <fmt/format.h>
#include <pango/pangocairo.h>

#include <algorithm>
#include <memory>
#include <string>

#include "canvas.h"
#include "content.h"

namespace dismantle {
namespace {

constexpr double kPageWidth = 842, kPageHeight = 595, kPaper = 40;  // points; margin
constexpr double kTextColour[3] = {0.13, 0.15, 0.19}, kSoftColour[3] = {0.4, 0.44, 0.52},
                 kAccentColour[3] = {0.76, 0.25, 0.05}, kForcedColour[3] = {0.8, 0, 0};

cairo_status_t append_pdf(void* bytes, const unsigned char* data, unsigned length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

/// A page after the other.
class PdfPages {
 public:
  explicit PdfPages(const std::string& title)
      : surface_(cairo_pdf_surface_create_for_stream(append_pdf, &bytes_, kPageWidth, kPageHeight)),
        page_(cairo_create(surface_)) {
    // Without a date: the same plan gives the same file.
    cairo_pdf_surface_set_metadata(surface_, CAIRO_PDF_METADATA_TITLE, title.c_str());
    cairo_pdf_surface_set_metadata(surface_, CAIRO_PDF_METADATA_CREATOR, "dismantle");
    cairo_pdf_surface_set_metadata(surface_, CAIRO_PDF_METADATA_CREATE_DATE, "");
  }
  ~PdfPages() {
    cairo_destroy(page_);
    cairo_surface_destroy(surface_);
  }
  PdfPages(const PdfPages&) = delete;
  PdfPages& operator=(const PdfPages&) = delete;

  /// Text in a column of `width`, at most `most` high (the rest becomes an ellipsis). Returns its height.
  double text(double x, double y, double width, const std::string& words, double size, const double colour[3],
              bool bold = false, double most = 400) {
    const std::unique_ptr<PangoLayout, decltype(&g_object_unref)> layout(pango_cairo_create_layout(page_),
                                                                         g_object_unref);
    PangoFontDescription* font = pango_font_description_from_string("Sans");
    pango_font_description_set_absolute_size(font, size * PANGO_SCALE);
    if (bold) pango_font_description_set_weight(font, PANGO_WEIGHT_BOLD);
    pango_layout_set_font_description(layout.get(), font);
    pango_font_description_free(font);
    pango_layout_set_width(layout.get(), static_cast<int>(width * PANGO_SCALE));
    pango_layout_set_wrap(layout.get(), PANGO_WRAP_WORD_CHAR);
    pango_layout_set_height(layout.get(), static_cast<int>(most * PANGO_SCALE));
    pango_layout_set_ellipsize(layout.get(), PANGO_ELLIPSIZE_END);
    pango_layout_set_text(layout.get(), words.c_str(), static_cast<int>(words.size()));
    cairo_set_source_rgb(page_, colour[0], colour[1], colour[2]);
    cairo_move_to(page_, x, y);
    pango_cairo_show_layout(page_, layout.get());
    int height = 0;
    pango_layout_get_size(layout.get(), nullptr, &height);
    return double(height) / PANGO_SCALE;
  }

  /// A list of facts. Returns its height; nothing is written below `bottom`.
  double facts(double x, double y, double width, const Facts& facts, double size, double bottom) {
    const double begin = y, column = 6.6 * size;
    for (const auto& [name, value] : facts) {
      if (y + 1.4 * size > bottom) break;
      const double most = bottom - y;
      const double a = text(x, y, column - 6, name, size, kSoftColour, false, most);
      const double b = text(x + column, y, width - column, value, size, kTextColour, false, std::min(most, 3.9 * size));
      y += std::max(a, b) + 2;
    }
    return y - begin;
  }

  /// In the middle of a box, as large as fits.
  void picture(const Picture& p, double x, double y, double width, double height) {
    const double scale = std::min(width / p.image.width, height / p.image.height);
    paint_picture(page_, p, x + 0.5 * (width - scale * p.image.width), y + 0.5 * (height - scale * p.image.height),
                  scale);
  }

  void frame(double x, double y, double width, double height) {
    cairo_set_source_rgb(page_, 0.84, 0.86, 0.89);
    cairo_set_line_width(page_, 0.8);
    cairo_rectangle(page_, x, y, width, height);
    cairo_stroke(page_);
  }

  void end_page() { cairo_show_page(page_); }

  std::string finish() {
    check_cairo(cairo_status(page_), "a page");
    cairo_surface_finish(surface_);
    check_cairo(cairo_surface_status(surface_), "the PDF");
    return std::move(bytes_);
  }

 private:
  std::string bytes_;
  cairo_surface_t* surface_;
  cairo_t* page_;
};

void title_page(PdfPages& pdf, const BookContent& content, const BookPictures& fronts) {
  double y = kPaper;
  const double width = kPageWidth - 2 * kPaper;
  y += pdf.text(kPaper, y, width, content.title, 30, kTextColour, true, 80) + 2;
  y += pdf.text(kPaper, y, width, content.subtitle, 14, kSoftColour) + 6;
  for (const std::string& warning : content.warnings)
    y += pdf.text(kPaper, y, width, warning, 10.5, kAccentColour, false, 42) + 4;
  const double facts_height = 118, height = kPageHeight - kPaper - facts_height - y;
  pdf.picture(fronts.whole, kPaper, y, 0.5 * width - 10, height - 8);
  pdf.picture(fronts.exploded, kPaper + 0.5 * width + 10, y, 0.5 * width - 10, height - 8);
  pdf.facts(kPaper, kPageHeight - kPaper - facts_height, width, content.facts, 11, kPageHeight - kPaper);
  pdf.end_page();
}

void item_pages(PdfPages& pdf, const BookContent& content, const Assembly& assembly, const Illustrator& illustrator) {
  constexpr int kColumns = 5, kRows = 3;
  const double width = kPageWidth - 2 * kPaper, top = kPaper + 34, gap = 8;
  const double w = (width - (kColumns - 1) * gap) / kColumns,
               h = (kPageHeight - kPaper - top - (kRows - 1) * gap) / kRows;
  for (std::size_t i = 0; i < content.items.size(); ++i) {
    const std::size_t at = i % (kColumns * kRows);
    if (at == 0) pdf.text(kPaper, kPaper, width, "Bill of materials", 19, kTextColour, true);
    const BookItem& item = content.items[i];
    const double x = kPaper + double(at % kColumns) * (w + gap), y = top + double(at / kColumns) * (h + gap);
    pdf.frame(x, y, w, h);
    pdf.text(x + 6, y + 5, 40, fmt::format("({})", item.number), 11, kTextColour, true);
    pdf.text(x + w - 46, y + 5, 42, fmt::format("{} ×", item.parts.size()), 11, kTextColour, true);
    pdf.picture(illustrator.part(item.parts.front(), kItemWidth, kItemHeight), x + 6, y + 18, w - 12, h - 64);
    std::string names;
    for (const std::size_t part : item.parts) names += (names.empty() ? "" : ", ") + assembly.parts[part].name;
    double line = y + h - 44;
    line += pdf.text(x + 6, line, w - 12, item.name, 9.5, kTextColour, true, 12);
    if (item.parts.size() > 1) line += pdf.text(x + 6, line, w - 12, names, 7.5, kSoftColour, false, 10);
    pdf.text(x + 6, line, w - 12, item.size, 7.5, kSoftColour, false, 10);
    if (at + 1 == kColumns * kRows || i + 1 == content.items.size()) pdf.end_page();
  }
}

void pdf_step(PdfPages& pdf, const BookPage& page, const StepPictures& pictures, bool disassembly) {
  const double width = kPageWidth - 2 * kPaper, column = 0.33 * width, large = width - column - 18;
  pdf.text(kPaper, kPaper - 14, 0.7 * width, page.chapter, 10.5, kSoftColour);
  pdf.text(kPageWidth - kPaper - 96, kPaper - 14, 96, fmt::format("step {} of {}", page.number, page.count), 10.5,
           kSoftColour);
  pdf.picture(pictures.apart, kPaper, kPaper + 8, large, kPageHeight - 2 * kPaper - 24);
  if (const std::string caption = caption_of(pictures); !caption.empty())
    pdf.text(kPaper, kPageHeight - kPaper - 12, large, caption, 10, kSoftColour);

  const double x = kPageWidth - kPaper - column, placed_height = 150,
               bottom = kPageHeight - kPaper - placed_height - 24;
  double y = kPaper + 6;
  y += pdf.text(x, y, column, std::to_string(page.number), 36, kTextColour, true) + 2;
  y += pdf.text(x, y, column, page.verb + ":", 13, kTextColour) + 1;
  for (const auto& [item, words] : page.moving) {
    if (y + 16 > bottom) break;
    y += pdf.text(x, y, column, item == 0 ? words : fmt::format("({}) {}", item, words), 13, kTextColour, true, 34) + 1;
  }
  for (const std::string& motion : page.motions) {
    if (y + 16 > bottom) break;
    y += pdf.text(x, y, column, motion, 12, kAccentColour, true, 64) + 4;
    if (!page.warning.empty()) y += pdf.text(x, y, column, page.warning, 12, kForcedColour, true, 64) + 4;
  }
  pdf.facts(x, y + 2, column, page.facts, 9.5, bottom);
  pdf.text(x, bottom + 6, column, disassembly ? "before" : "after", 9.5, kSoftColour);
  pdf.frame(x, bottom + 22, column, placed_height);
  pdf.picture(pictures.placed, x + 4, bottom + 25, column - 8, placed_height - 6);
  pdf.end_page();
}

}  // namespace

std::string book_pdf(const Plan& plan, const Assembly& assembly, const BookOptions& options) {
  const Illustrator illustrator(assembly, options.frame.y_up);
  const BookContent content = book_content(plan, assembly, options, illustrator.shapes());
  PdfPages pdf(content.title);
  title_page(pdf, content, front_pictures(plan, assembly, illustrator));
  item_pages(pdf, content, assembly, illustrator);
  for (const BookPage& page : content.pages) {
    options.on_page(page.number, page.count);
    pdf_step(pdf, page,
             illustrator.step(*page.step, options.disassembly, kStepWidth * 3 / 2, kStepHeight * 3 / 2,
                              kPlacedWidth * 3 / 2, kPlacedHeight * 3 / 2),
             options.disassembly);
  }
  return pdf.finish();
}

}  // namespace dismantle
