// The book as PDF: A4 landscape, text by pango.
#include <cairo-pdf.h>
#include <fmt/format.h>
#include <pango/pangocairo.h>

#include <algorithm>
#include <memory>
#include <numbers>
#include <string>

#include "canvas.h"
#include "content.h"

namespace dismantle {
namespace {

cairo_status_t append_pdf(void* bytes, const unsigned char* data, unsigned length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

/// A line does not end between a sign and its axis: "towards -x".
std::string with_signs_kept(const std::string& words) {
  constexpr const char* kWordJoiner = "\u2060";
  const auto at = [&](std::size_t i) { return i < words.size() ? words[i] : ' '; };
  std::string out;
  for (std::size_t i = 0; i < words.size(); ++i) {
    out += words[i];
    const bool before = i == 0 || words[i - 1] == ' ' || words[i - 1] == '(';
    const bool axis = std::string("xyzXYZ").find(at(i + 1)) != std::string::npos;
    const bool ends = std::string(" ,.;:)").find(at(i + 2)) != std::string::npos;
    if (words[i] == '-' && before && axis && ends) out += kWordJoiner;
  }
  return out;
}

/// Writes the pages one after the other.
class PdfPages {
 public:
  PdfPages(const std::string& title, std::string foot)
      : foot_(std::move(foot)),
        surface_(cairo_pdf_surface_create_for_stream(append_pdf, &bytes_, style_.width, style_.height)),
        page_(cairo_create(surface_)) {
    // Without a date, so that the same plan gives the same file.
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

  /// Draws text in a column of `width`, at most `most` high: smaller than `size` if it needs to be, and only what does
  /// not fit in the smallest type either is replaced by an ellipsis. Returns its height.
  double text(double x, double y, double width, const std::string& words, double size, const Eigen::Vector3d& colour,
              bool bold = false, double most = 400) {
    while (size > style_.smallest_type && height_of(width, words, size, bold) > most)
      size = std::max(style_.smallest_type, 0.92 * size);
    const auto layout = layout_of(width, words, size, bold);
    pango_layout_set_height(layout.get(), static_cast<int>(most * PANGO_SCALE));
    pango_layout_set_ellipsize(layout.get(), PANGO_ELLIPSIZE_END);
    cairo_set_source_rgb(page_, colour[0], colour[1], colour[2]);
    cairo_move_to(page_, x, y);
    pango_cairo_show_layout(page_, layout.get());
    return height_in(layout.get());
  }
  double height_of(double width, const std::string& words, double size, bool bold) const {
    return height_in(layout_of(width, words, size, bold).get());
  }

  /// Draws a list of facts, nothing of it below `bottom`; a long one is set in smaller type if there is no room for
  /// all. Returns its height.
  double facts(double x, double y, double width, const Facts& facts, double size, double bottom) {
    const double begin = y, column = 6.6 * size;
    double whole = 0;
    for (const auto& [name, value] : facts)
      whole += 2 + std::max(height_of(column - 6, name, size, false), height_of(width - column, value, size, false));
    const double highest = y + whole <= bottom ? bottom - y : 5.2 * size;
    for (const auto& [name, value] : facts) {
      if (y + 1.4 * size > bottom) break;
      const double most = bottom - y;
      const double a = text(x, y, column - 6, name, size, style_.soft, false, most);
      const double b = text(x + column, y, width - column, value, size, style_.text, false, std::min(most, highest));
      y += std::max(a, b) + 2;
    }
    return y - begin;
  }

  /// Draws the picture centred in a box, as large as possible.
  void picture(const Picture& p, double x, double y, double width, double height) {
    const double scale = std::min(width / p.image.width, height / p.image.height);
    const double left = x + 0.5 * (width - scale * p.image.width), top = y + 0.5 * (height - scale * p.image.height);
    paint_picture(page_, p, left, top, scale);
    for (const Balloon& b : p.balloons) {
      const Eigen::Vector2d corner(left, top), at = corner + scale * b.at, middle = corner + scale * b.middle;
      balloon(at, middle, scale * balloon_radius(p.image.width), b);
    }
  }

  void balloon(const Eigen::Vector2d& at, const Eigen::Vector2d& middle, double radius, const Balloon& b) {
    const Eigen::Vector3d& colour = b.held ? style_.held : style_.text;
    const auto ink = [&] { cairo_set_source_rgb(page_, colour[0], colour[1], colour[2]); };
    const auto disc = [&](const Eigen::Vector2d& m, double r) {
      cairo_new_path(page_);
      cairo_arc(page_, m.x(), m.y(), r, 0, 2 * std::numbers::pi);
    };
    ink();
    cairo_set_line_width(page_, 0.7);
    cairo_new_path(page_);
    cairo_move_to(page_, at.x(), at.y());
    cairo_line_to(page_, middle.x(), middle.y());
    cairo_stroke(page_);
    disc(at, 1.2);
    cairo_fill(page_);
    disc(middle, radius);
    cairo_set_source_rgb(page_, 1, 1, 1);
    cairo_fill_preserve(page_);
    ink();
    cairo_stroke(page_);
    const auto number = layout_of(-1, std::to_string(b.number), (b.number < 100 ? 1.15 : 0.9) * radius, true);
    int wide = 0, high = 0;
    pango_layout_get_size(number.get(), &wide, &high);
    cairo_move_to(page_, middle.x() - 0.5 * wide / PANGO_SCALE, middle.y() - 0.5 * high / PANGO_SCALE);
    pango_cairo_show_layout(page_, number.get());
  }

  void frame(double x, double y, double width, double height) {
    cairo_set_source_rgb(page_, 0.84, 0.86, 0.89);
    cairo_set_line_width(page_, 0.8);
    cairo_rectangle(page_, x, y, width, height);
    cairo_stroke(page_);
  }

  void end_page() {
    const std::string number = std::to_string(++pages_);
    text(style_.width - style_.margin - 30, style_.height - 24, 30, number, 9, style_.soft);
    if (!foot_.empty()) text(style_.margin, style_.height - 24, 400, foot_, 9, style_.soft, false, 12);
    cairo_show_page(page_);
  }

  std::string finish() {
    check_cairo(cairo_status(page_), "a page");
    cairo_surface_finish(surface_);
    check_cairo(cairo_surface_status(surface_), "the PDF");
    return std::move(bytes_);
  }

  const PageStyle& style() const { return style_; }

 private:
  using Layout = std::unique_ptr<PangoLayout, decltype(&g_object_unref)>;

  Layout layout_of(double width, const std::string& words, double size, bool bold) const {
    Layout layout(pango_cairo_create_layout(page_), g_object_unref);
    PangoFontDescription* font = pango_font_description_from_string("Sans");
    pango_font_description_set_absolute_size(font, size * PANGO_SCALE);
    if (bold) pango_font_description_set_weight(font, PANGO_WEIGHT_BOLD);
    pango_layout_set_font_description(layout.get(), font);
    pango_font_description_free(font);
    pango_layout_set_width(layout.get(), width < 0 ? -1 : static_cast<int>(width * PANGO_SCALE));
    pango_layout_set_wrap(layout.get(), PANGO_WRAP_WORD_CHAR);
    // A long name goes on in the next line as it is: a hyphen would be read as part of it.
    PangoAttrList* attributes = pango_attr_list_new();
    pango_attr_list_insert(attributes, pango_attr_insert_hyphens_new(FALSE));
    pango_layout_set_attributes(layout.get(), attributes);
    pango_attr_list_unref(attributes);
    const std::string kept = with_signs_kept(words);
    pango_layout_set_text(layout.get(), kept.c_str(), static_cast<int>(kept.size()));
    return layout;
  }
  static double height_in(PangoLayout* layout) {
    int height = 0;
    pango_layout_get_size(layout, nullptr, &height);
    return double(height) / PANGO_SCALE;
  }

  PageStyle style_;
  std::string foot_;       // of each page
  std::size_t pages_ = 0;  // that are done
  std::string bytes_;
  cairo_surface_t* surface_;
  cairo_t* page_;
};

void title_page(PdfPages& pdf, const BookContent& content, const BookPictures& fronts) {
  const PageStyle& style = pdf.style();
  const double margin = style.margin;
  double y = margin;
  const double width = style.width - 2 * margin;
  y += pdf.text(margin, y, width, content.title, 30, style.text, true, 80) + 2;
  y += pdf.text(margin, y, width, content.subtitle, 14, style.soft) + 6;
  for (const std::string& warning : content.warnings)
    y += pdf.text(margin, y, width, warning, 10.5, style.accent, false, 42) + 4;
  const double facts_height = 118, height = style.height - margin - facts_height - y;
  pdf.picture(fronts.whole, margin, y, 0.5 * width - 10, height - 8);
  pdf.picture(fronts.exploded, margin + 0.5 * width + 10, y, 0.5 * width - 10, height - 8);
  pdf.facts(margin, style.height - margin - facts_height, width, content.facts, 11, style.height - margin);
  pdf.end_page();
}

std::size_t item_page_count(const BookContent& content, const PageStyle& style) {
  const auto per_page = static_cast<std::size_t>(style.item_columns * style.item_rows);
  return (content.items.size() + per_page - 1) / per_page;
}

constexpr double kJobLine = 26;  // height; two lines of small type

std::size_t job_rows(const PageStyle& style) {
  return static_cast<std::size_t>((style.height - 2 * style.margin - 34) / kJobLine);
}
std::size_t job_page_count(const BookContent& content, const PageStyle& style) {
  const std::size_t per_page = 2 * job_rows(style);
  return (content.job.size() + per_page - 1) / per_page;
}

/// Two columns of fasteners and tools.
void job_pages(PdfPages& pdf, const BookContent& content, const BookWords& words) {
  const PageStyle& style = pdf.style();
  const double margin = style.margin, gap = 30, width = 0.5 * (style.width - 2 * margin - gap);
  const std::size_t rows = job_rows(style), per_page = 2 * rows;
  for (std::size_t i = 0; i < content.job.size(); ++i) {
    const std::size_t at = i % per_page;
    if (at == 0)
      pdf.text(margin, margin, style.width - 2 * margin, words.label("Fasteners and tools"), 19, style.text, true);
    const double x = margin + (at < rows ? 0 : width + gap), y = margin + 34 + double(at % rows) * kJobLine;
    const ContentsLine& line = content.job[i];
    pdf.text(x + (line.heading ? 0 : 10), y, width - 10, line.words, 10, style.text, line.heading, kJobLine - 1);
    if (at + 1 == per_page || i + 1 == content.job.size()) pdf.end_page();
  }
}

/// What was checked, from the top, on as many pages as it takes.
void account_pages(PdfPages& pdf, const BookContent& content, const BookWords& words) {
  const PageStyle& style = pdf.style();
  const double margin = style.margin, width = style.width - 2 * margin, indent = 10, size = 10.5;
  double y = style.height;  // no page yet
  for (std::size_t i = 0; i < content.account.size(); ++i) {
    const ContentsLine& line = content.account[i];
    const double left = line.heading ? 0 : indent, height = pdf.height_of(width - left, line.words, size, line.heading);
    const double room = line.heading ? 8 + 3 * size : 0;  // no heading at the foot of a page
    if (y + height + room > style.height - margin) {
      if (i > 0) pdf.end_page();
      pdf.text(margin, margin, width, words.label("What was checked"), 19, style.text, true);
      y = margin + 34;
    }
    if (line.heading) y += 8;
    y += pdf.text(margin + left, y, width - left, line.words, size, style.text, line.heading) + 3;
  }
  if (!content.account.empty()) pdf.end_page();
}

/// Two columns of lines with the numbers of their pages.
void contents_pages(PdfPages& pdf, const BookContent& content, const BookWords& words) {
  if (content.contents.empty()) return;
  const PageStyle& style = pdf.style();
  const double margin = style.margin, top = margin + 34, line_height = 15, gap = 30;
  const double width = 0.5 * (style.width - 2 * margin - gap), number_width = 30;
  const auto rows = static_cast<std::size_t>((style.height - margin - top) / line_height);
  const std::size_t lines = content.contents.size() + 1, per_page = 2 * rows;
  const std::size_t materials = 2 + (lines + per_page - 1) / per_page;  // number of that page; the title has 1
  const std::size_t steps = materials + item_page_count(content, style) + job_page_count(content, style);
  for (std::size_t i = 0; i < lines; ++i) {
    const std::size_t at = i % per_page;
    if (at == 0) pdf.text(margin, margin, style.width - 2 * margin, words.label("Contents"), 19, style.text, true);
    const double x = margin + (at < rows ? 0 : width + gap), y = top + double(at % rows) * line_height;
    const ContentsLine line =
        i == 0 ? ContentsLine{words.label("Bill of materials"), 0, true} : content.contents[i - 1];
    pdf.text(x + (line.heading ? 0 : 10), y, width - number_width - 10, line.words, 10, style.text, line.heading, 13);
    pdf.text(x + width - number_width, y, number_width, std::to_string(i == 0 ? materials : steps + line.page), 10,
             style.soft);
    if (at + 1 == per_page || i + 1 == lines) pdf.end_page();
  }
}

void item_pages(PdfPages& pdf, const BookContent& content, const Illustrator& illustrator, const BookWords& words) {
  const PageStyle& style = pdf.style();
  const double margin = style.margin;
  const int columns = style.item_columns, rows = style.item_rows;
  const auto per_page = static_cast<std::size_t>(columns * rows);
  const double width = style.width - 2 * margin, top = margin + 34, gap = 8;
  const double w = (width - (columns - 1) * gap) / columns, h = (style.height - margin - top - (rows - 1) * gap) / rows;
  for (std::size_t i = 0; i < content.items.size(); ++i) {
    const std::size_t at = i % per_page;
    if (at == 0) {
      pdf.text(margin, margin, 180, words.label("Bill of materials"), 19, style.text, true);
      if (!content.base.empty())
        pdf.text(margin + 190, margin + 4, width - 190, content.base, 9.5, style.soft, false, 26);
    }
    const BookItem& item = content.items[i];
    const double x = margin + double(at % style.item_columns) * (w + gap),
                 y = top + double(at / style.item_columns) * (h + gap);
    pdf.frame(x, y, w, h);
    pdf.text(x + 6, y + 5, 40, fmt::format("({})", item.number), 11, style.text, true);
    pdf.text(x + w - 46, y + 5, 42, fmt::format("{} ×", item.names.size()), 11, style.text, true);
    // Long names take from the picture.
    const bool several = item.names.size() > 1;
    const std::string names = fmt::format("{}", fmt::join(item.names, ", "));
    const double name_height = std::min(pdf.height_of(w - 12, item.name, 9.5, true), 30.0);
    const double names_height = several ? std::min(pdf.height_of(w - 12, names, 7.5, false), 30.0) : 0;
    const double size_height = std::min(pdf.height_of(w - 12, item.size, 7.5, false), 20.0);
    double line = y + h - name_height - names_height - size_height - 6;
    pdf.picture(illustrator.scene(item.picture, illustrator.style().item), x + 6, y + 18, w - 12, line - y - 20);
    line += pdf.text(x + 6, line, w - 12, item.name, 9.5, style.text, true, 30);
    if (several) line += pdf.text(x + 6, line, w - 12, names, 7.5, style.soft, false, 30);
    pdf.text(x + 6, line, w - 12, item.size, 7.5, style.soft, false, 20);
    if (at + 1 == per_page || i + 1 == content.items.size()) pdf.end_page();
  }
}

/// The box of the parts of a step, from the left; those without room are left out. Returns its height.
double pdf_box(PdfPages& pdf, const BookPage& page, const Illustrator& illustrator, double x, double y, double width) {
  if (page.box.empty()) return 0;
  const PageStyle& style = pdf.style();
  const std::size_t room = static_cast<std::size_t>(width / style.box_width), n = std::min(room, page.box.size());
  pdf.frame(x, y, double(n) * style.box_width, style.box_height);
  for (std::size_t k = 0; k < n; ++k) {
    const BoxEntry& entry = page.box[k];
    const double left = x + double(k) * style.box_width;
    pdf.picture(illustrator.scene(entry.picture, illustrator.style().item), left + 6, y + 4, style.box_width - 12,
                style.box_height - 22);
    const std::string words =
        entry.item == 0 ? fmt::format("{} ×", entry.count) : fmt::format("({})  {} ×", entry.item, entry.count);
    pdf.text(left + 8, y + style.box_height - 16, style.box_width - 10, words, 10, style.text, true, 13);
  }
  return style.box_height + 6;
}

void pdf_step(PdfPages& pdf, const BookPage& page, const StepPictures& pictures, const Illustrator& illustrator,
              const BookWords& words, bool disassembly) {
  const PageStyle& style = pdf.style();
  const double margin = style.margin;
  const double width = style.width - 2 * margin, column = 0.33 * width, large = width - column - 18;
  pdf.text(margin, margin - 14, 0.7 * width, page.chapter, 10.5, style.soft);
  pdf.text(style.width - margin - 130, margin - 14, 130,
           fmt::format(fmt::runtime(words.label("step {} of {}")), page.numbers(), page.count), 10.5, style.soft);
  const double box = pdf_box(pdf, page, illustrator, margin, margin + 8, large);
  pdf.picture(pictures.apart, margin, margin + 8 + box, large, style.height - 2 * margin - 24 - box);
  if (const std::string caption = caption_of(pictures, words); !caption.empty())
    pdf.text(margin, style.height - margin - 12, large, caption, 10, style.soft);

  const double x = style.width - margin - column, placed_height = 150,
               bottom = style.height - margin - placed_height - 24;
  double y = margin + 6;
  y += pdf.text(x, y, column, page.numbers(), 36, style.text, true) + 2;
  y += pdf.text(x, y, column, page.verb + ":", 13, style.text) + 1;
  for (const auto& [item, name] : page.moving) {
    if (y + 16 > bottom) break;
    y += pdf.text(x, y, column, item == 0 ? name : fmt::format("({}) {}", item, name), 13, style.text, true, 34) + 1;
  }
  for (const std::string& motion : page.motions) {
    if (y + 16 > bottom) break;
    y += pdf.text(x, y, column, motion, 12, style.accent, true, 64) + 4;
    if (!page.warning.empty()) y += pdf.text(x, y, column, page.warning, 12, style.forced, true, 64) + 4;
  }
  for (const std::string& note : page.own_notes)
    if (y + 16 <= bottom) y += pdf.text(x, y, column, note, 11, style.held, false, std::min(90.0, bottom - y)) + 4;
  pdf.facts(x, y + 2, column, page.facts, 9.5, bottom);
  pdf.text(x, bottom + 6, column, words.label(disassembly ? "before" : "after"), 9.5, style.soft);
  pdf.frame(x, bottom + 22, column, placed_height);
  pdf.picture(pictures.placed, x + 4, bottom + 25, column - 8, placed_height - 6);
  pdf.end_page();
}

}  // namespace

std::string book_pdf(const Plan& plan, const Assembly& assembly, const BookOptions& options) {
  const Illustrator illustrator(assembly, options.frame.up);
  const BookWords words(options.language, options.phrases);
  const BookContent content = book_content(plan, assembly, options, illustrator.shapes());
  PdfPages pdf(content.title, options.revision.empty() ? "" : content.title + " · " + options.revision);
  title_page(pdf, content, front_pictures(plan, assembly, illustrator, content.numbers));
  contents_pages(pdf, content, words);
  item_pages(pdf, content, illustrator, words);
  job_pages(pdf, content, words);
  std::size_t done = 0;
  for (const BookPage& page : content.pages) {
    options.on_page(++done, content.pages.size());
    const StepPictures pictures = illustrator.step(*page.step, options.disassembly, 1.5, content.numbers, page.held);
    pdf_step(pdf, page, pictures, illustrator, words, options.disassembly);
  }
  account_pages(pdf, content, words);
  return pdf.finish();
}

}  // namespace dismantle
