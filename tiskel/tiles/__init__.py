"""Clouds too large for one run: cells that are counted, boxes that overlap, objects, and curves joined again."""
