"""Views of finished results: tables, figures, one page an experiment."""
