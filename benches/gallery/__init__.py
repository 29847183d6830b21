"""A small scene for every block, rendered by Steradian and by Mitsuba 3, compared pixel by pixel."""
