"""The sections of the report: title, sentences, tables and pictures, made from what a survey produced."""
