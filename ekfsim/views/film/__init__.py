"""Pictures one after another: numbered files, GIF, MP4."""
