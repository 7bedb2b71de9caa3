"""The engines that are measured, one file each. What a file must offer stands at the head of measure.py."""
