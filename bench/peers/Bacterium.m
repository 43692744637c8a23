classdef Bacterium < handle
  % One bacterium of the simulator of the thesis, Basic model (theory A2, A4): an object with position and speed that
  % computes its next position on the grid. In pixels and iterations.
  properties
    x
    y
    vx = 0
    vy = 0
  end
  methods
    function self = Bacterium(x, y)
      self.x = x;
      self.y = y;
    end
    function [x, y] = getPos(self)
      x = self.x;
      y = self.y;
    end
    function setPos(self, x, y)
      self.x = x;
      self.y = y;
    end
    function changeSpeed(self, maxSpeed, magX, magY)
      self.vx = randi(2 * maxSpeed + 1) - maxSpeed - 1 + magX;
      self.vy = randi(2 * maxSpeed + 1) - maxSpeed - 1 + magY;
    end
    function [x, y] = nextPos(self, grid)
      x = min(max(self.x + self.vx, 1), size(grid, 2));
      y = min(max(self.y + self.vy, 1), size(grid, 1));
      if grid(y, x)
        x = self.x;
        y = self.y;
      end
    end
  end
end
